// Over a point of a plot: its settings and its picture, which the table below holds.
const card = document.getElementById("card");
for (const hit of document.querySelectorAll(".hit")) {
  const title = hit.querySelector("title");
  const text = title.textContent;
  const show = () => {
    const picture = document.getElementById(hit.dataset.cell)?.querySelector("img");
    card.replaceChildren();
    if (picture) card.append(picture.cloneNode());
    card.append(text);
    title.textContent = "";
    card.hidden = false;
    const at = hit.getBoundingClientRect();
    const left = Math.min(at.right + 8, innerWidth - card.offsetWidth - 8);
    const top = Math.min(at.bottom + 8, innerHeight - card.offsetHeight - 8);
    card.style.left = `${Math.max(8, left)}px`;
    card.style.top = `${Math.max(8, top)}px`;
  };
  const hide = () => { card.hidden = true; title.textContent = text; };
  hit.addEventListener("pointerenter", show);
  hit.addEventListener("pointerleave", hide);
  hit.addEventListener("focus", show);
  hit.addEventListener("blur", hide);
}
