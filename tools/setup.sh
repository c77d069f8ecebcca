# Sourced by tools/demo and tools/test: goes to the repository's root, checks Rust, installs what is missing.
# shellcheck shell=bash
set -euo pipefail
CDPATH='' cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    printf '%s: %s\n' "$0" "$*" >&2
    exit 1
}

# A shell opened before Rust was installed does not have Cargo's folder on its path.
PATH="$PATH:${CARGO_HOME:-${HOME:-}/.cargo}/bin"

need_rust() {
    local wanted found
    wanted=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
    command -v cargo >/dev/null || fail "Cargo is missing: install Rust $wanted or newer from https://rustup.rs"
    found=$(cargo --version | cut -d ' ' -f 2)
    [ "$(printf '%s\n' "$wanted" "$found" | sort -V | head -n 1)" = "$wanted" ] ||
        fail "Rust $wanted or newer is needed, this is $found: run 'rustup update', or see https://rustup.rs"
}

# Each argument is a Debian package; nothing is asked of apt when all of them are there.
need_packages() {
    local package missing=() as_root=()
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        warn_without_apt "$*"
        return
    fi
    for package; do
        dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "needs root or sudo to install these Debian packages: ${missing[*]}"
        as_root=(sudo)
    fi
    echo "Installing these Debian packages: ${missing[*]}"
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
        apt-get -q -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
    # One unreachable third-party source must not stop what the others can serve.
    "${apt[@]}" update || echo "apt-get update failed; trying with the package lists at hand" >&2
    "${apt[@]}" install -y --no-install-recommends "${missing[@]}" ||
        fail "could not install these Debian packages: ${missing[*]}"
}

# Other systems name their packages differently, so this only tells; the build or the renderer has the last word.
warn_without_apt() {
    local absent=()
    command -v c++ >/dev/null || absent+=("a C++ compiler (c++)")
    PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null | grep 'libvulkan\.so\.1' >/dev/null ||
        absent+=("the Vulkan loader (libvulkan.so.1)")
    compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null || compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null ||
        absent+=("a Vulkan driver (Mesa's lavapipe needs no GPU)")
    [ ${#absent[@]} -eq 0 ] && return
    printf 'No apt here. On Debian these would be installed: %s. Not found:\n' "$1" >&2
    printf '  %s\n' "${absent[@]}" >&2
}
