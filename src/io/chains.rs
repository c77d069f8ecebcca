//! Runs of vertices that meet end to end, joined into curves.

/// Elements, each a run of two or more vertices.
#[derive(Clone, Debug, Default)]
pub struct Elements {
    /// Vertex indices of all elements, one after the other, counted from 0.
    pub indices: Vec<usize>,
    /// Where each element ends in `indices`; it starts where the one before ends.
    pub ends: Vec<usize>,
}

/// A curve through vertices; a closed one does not repeat its first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// The vertices, in order.
    pub vertices: Vec<usize>,
    /// Whether the last joins the first.
    pub closed: bool,
}

impl Elements {
    /// The vertices of one element.
    pub fn element(&self, element: usize) -> &[usize] {
        let start = if element == 0 { 0 } else { self.ends[element - 1] };
        &self.indices[start..self.ends[element]]
    }

    /// Adds an element of two or more vertices.
    pub fn push(&mut self, vertices: impl IntoIterator<Item = usize>) {
        self.indices.extend(vertices);
        self.ends.push(self.indices.len());
    }

    /// The curves, and the number of vertices where three or more element ends meet: curves end there. All indices must
    /// be below `vertex_count`.
    pub fn chained(&self, vertex_count: usize) -> (Vec<Chain>, usize) {
        let joints = Joints::new(self, vertex_count);
        let mut used = vec![false; self.ends.len()];
        let mut curves = Vec::new();
        for element in 0..self.ends.len() {
            if used[element] {
                continue;
            }
            let chain = joints.chain_through(element);
            for end in &chain {
                used[end / 2] = true;
            }
            curves.push(self.curve(&chain));
        }
        (curves, joints.junctions())
    }

    /// The curve through elements entered at the given ends.
    fn curve(&self, chain: &[usize]) -> Chain {
        let mut vertices: Vec<usize> = Vec::new();
        for &end in chain {
            // Each element starts at the vertex where the one before ended.
            vertices.pop();
            let element = self.element(end / 2).iter();
            if end.is_multiple_of(2) { vertices.extend(element) } else { vertices.extend(element.rev()) }
        }
        let closed = vertices.first() == vertices.last();
        if closed {
            vertices.pop();
        }
        Chain { vertices, closed }
    }
}

/// Which element ends meet. End 2e is the start of element e, end 2e + 1 its finish.
struct Joints<'a> {
    elements: &'a Elements,
    /// Per vertex: how many ends are there, and the first two of them.
    at: Vec<(u32, [usize; 2])>,
}

impl<'a> Joints<'a> {
    fn new(elements: &'a Elements, vertex_count: usize) -> Self {
        let mut joints = Self { elements, at: vec![(0, [0; 2]); vertex_count] };
        for end in 0..2 * elements.ends.len() {
            let vertex = joints.vertex(end);
            let (count, ends) = &mut joints.at[vertex];
            if *count < 2 {
                ends[*count as usize] = end;
            }
            *count = count.saturating_add(1);
        }
        joints
    }

    fn vertex(&self, end: usize) -> usize {
        let element = self.elements.element(end / 2);
        if end.is_multiple_of(2) { element[0] } else { element[element.len() - 1] }
    }

    fn junctions(&self) -> usize {
        self.at.iter().filter(|(count, _)| *count > 2).count()
    }

    /// The end that `end` continues into: only where exactly two meet.
    fn mate(&self, end: usize) -> Option<usize> {
        let (count, ends) = self.at[self.vertex(end)];
        (count == 2).then(|| if ends[0] == end { ends[1] } else { ends[0] })
    }

    /// Every element joined to this one, in order along the curve, each as the end it is entered at.
    fn chain_through(&self, element: usize) -> Vec<usize> {
        let start = 2 * element;
        let mut chain = vec![start];
        let mut leaving = start + 1;
        while let Some(next) = self.mate(leaving) {
            if next == start {
                return chain;
            }
            chain.push(next);
            leaving = next ^ 1;
        }
        let mut before = Vec::new();
        let mut entering = start;
        while let Some(previous) = self.mate(entering) {
            entering = previous ^ 1;
            before.push(entering);
        }
        before.reverse();
        before.append(&mut chain);
        before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_meet_are_one_curve_and_forks_end_curves() {
        let mut elements = Elements::default();
        for run in [&[0, 1][..], &[2, 1], &[2, 3, 4], &[5, 6], &[6, 7], &[7, 5], &[8, 9], &[9, 10], &[9, 11]]
        {
            elements.push(run.iter().copied());
        }
        let (curves, junctions) = elements.chained(12);
        let chain = |vertices: &[usize], closed| Chain { vertices: vertices.to_vec(), closed };
        let expected = [
            chain(&[0, 1, 2, 3, 4], false),
            chain(&[5, 6, 7], true),
            chain(&[8, 9], false),
            chain(&[9, 10], false),
            chain(&[9, 11], false),
        ];
        assert_eq!((curves, junctions), (expected.to_vec(), 1));
    }
}
