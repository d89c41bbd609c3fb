#!/usr/bin/env bash
# Makes the packages of a release from a clone, on Linux on x86-64. What cannot be made there is skipped, with what would
# make it possible.
#
#     bash docs/package.sh              # all
#     bash docs/package.sh linux deb    # some of: linux aarch64 windows deb wheel web vscode container sbom rays
#
# Writes to target/package. The programs for Linux need no library of the system. They are linked by cargo-zigbuild
# (`pip install cargo-zigbuild`) where the targets of musl are not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
# The manifest names the files of the Debian package by their folder.
unset CARGO_TARGET_DIR
. .ci/targets

out=target/package
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
# The time of all files: with the order and the owner, the same commit makes the same archives.
time=$(git log -1 --format=%ct 2> /dev/null || echo 0)
export SOURCE_DATE_EPOCH=$time
export CARGO_PROFILE_DIST_STRIP=true
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rm -rf "$out"
mkdir -p "$out"

skip() { echo "SKIPPED: $*" >&2; }
# Tells whether a program is here, and else what would bring it.
has() { command -v "$1" > /dev/null || { skip "$1 is not here ($2)" && false; }; }

# Compiles the program for a target.
compiled() {
    local target=$1 build=build
    case $target-$(library "$target") in
        *-) skip "the standard library for $target is not here (rustup target add $target)" && return 1 ;;
        # Its linker needs nothing else.
        aarch64-unknown-linux-musl-here) export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld ;;
        *-musl-here) ;;
        *-musl-*)
            has cargo-zigbuild "rustup target add $target, or pip install cargo-zigbuild" || return 1
            build=zigbuild
            ;;
        *-windows-gnu-*) has x86_64-w64-mingw32-gcc "apt-get install gcc-mingw-w64-x86-64" || return 1 ;;
    esac
    on "$target" $build --profile dist --locked --bin tabray
}

# What the program of this machine writes: man pages and completions. With scenes, this is what packages have in common.
files() {
    local shell
    if [ -d "$out/files" ]; then
        return
    fi
    program=target/x86_64-unknown-linux-musl/dist/tabray
    if ! compiled x86_64-unknown-linux-musl; then
        cargo build --profile dist --locked --bin tabray
        program=target/dist/tabray
    fi
    mkdir -p "$out/files/completions"
    "$program" man "$out/files/man1" 2> /dev/null
    gzip -9n "$out/files"/man1/*.1
    for shell in bash:tabray zsh:_tabray fish:tabray.fish powershell:_tabray.ps1; do
        "$program" completions "${shell%:*}" > "$out/files/completions/${shell#*:}"
    done
    "$program" grammar > "$out/files/tabray.tmLanguage.json"
    cp -r scenes/gallery "$out/files/scenes"
}

# Makes an archive of the folder of that name.
archive() {
    find "$out/$1" -exec touch --no-dereference --date="@$time" {} +
    if [[ $1 == *-windows ]]; then
        (cd "$out" && find "$1" | LC_ALL=C sort | TZ=UTC zip --quiet -X -@ "$1.zip")
    else
        tar --sort=name --owner=0 --group=0 --numeric-owner -C "$out" -c "$1" | gzip -9n > "$out/$1.tar.gz"
    fi
    rm -r "${out:?}/$1"
}

# Makes the archive of a target: `bundle TARGET NAME PROGRAM`.
bundle() {
    local folder=tabray-$version-$2
    compiled "$1" || return 0
    files
    mkdir "$out/$folder"
    cp "target/$1/dist/$3" README.md CHANGELOG.md LICENSE "$out/$folder/"
    cp -r "$out/files"/{completions,man1,scenes} "$out/$folder/"
    archive "$folder"
}

linux() { bundle x86_64-unknown-linux-musl x86_64-linux tabray; }
aarch64() { bundle aarch64-unknown-linux-musl aarch64-linux tabray; }
windows() { ! has zip "apt-get install zip" || bundle x86_64-pc-windows-gnu x86_64-windows tabray.exe; }

deb() {
    local target
    has cargo-deb "cargo install --locked cargo-deb" || return 0
    files
    for target in x86_64-unknown-linux-musl aarch64-unknown-linux-musl; do
        # The manifest does not know the version, and so takes files from target/package/files.
        [ ! -f "target/$target/dist/tabray" ] ||
            cargo deb --quiet --locked --no-build --no-strip --profile dist --target "$target" --output "$out/"
    done
}

wheel() {
    has maturin "pip install 'maturin[zig]'" || return 0
    # With zig, it runs where the C library is of 2014 or newer; else where it is as new as here.
    local zig=()
    ! python3 -m ziglang version > /dev/null 2>&1 || zig=(--zig --compatibility manylinux2014)
    maturin build --locked --profile dist --quiet "${zig[@]}" --manifest-path src/python/Cargo.toml --out "$out"
}

web() {
    local cargo=(cargo) name=tabray-$version-web target=wasm32-unknown-unknown
    [ -n "$(library $target)" ] || { skip "the page for browsers (rustup target add $target)" && return; }
    [ "$(library $target)" != system ] || cargo=(env RUSTC=/usr/bin/rustc /usr/bin/cargo)
    "${cargo[@]}" run --locked --quiet -p tabray-web-build
    # One file that needs no server, and a folder to be served.
    cp target/web/tabray.html "$out/tabray-$version.html"
    mkdir "$out/$name"
    cp target/web/{index.html,tabray.wasm,offline.js,tabray.webmanifest,icon.svg} LICENSE "$out/$name/"
    archive "$name"
}

vscode() {
    has npm "apt-get install npm" || return 0
    files
    cp -r docs/editors/vscode "$work/vscode"
    rm -rf "$work/vscode/node_modules"
    cp "$out/files/tabray.tmLanguage.json" LICENSE "$work/vscode/"
    if (cd "$work/vscode" && npm install --silent --omit=dev --no-audit --no-fund &&
        npx --yes @vscode/vsce package --allow-missing-repository --out "$work/tabray.vsix" > "$work/vsce.log"); then
        mv "$work/tabray.vsix" "$out/tabray-$version.vsix"
    else
        skip "the extension (it needs npm's registry)"
    fi
}

container() {
    local context=$work/container program=target/x86_64-unknown-linux-musl/dist/tabray
    [ -f $program ] || { skip "the container image (bash docs/package.sh linux container)" && return; }
    has buildah "apt-get install buildah" || return 0
    mkdir "$context"
    cp $program "$context/"
    buildah() { command buildah --root "$work/images" --storage-driver vfs "$@"; }
    buildah build --quiet --timestamp "$time" --target program --file docs/cluster/Containerfile \
        --tag "tabray:$version" "$context" > /dev/null
    buildah push --quiet "tabray:$version" "oci-archive:$out/tabray-$version-container.tar:tabray:$version"
}

# What the program is built from: CycloneDX.
sbom() {
    has cargo-cyclonedx "cargo install --locked cargo-cyclonedx" || return 0
    # It writes beside each manifest.
    git archive --prefix=source/ HEAD | tar -x -C "$work"
    cargo cyclonedx --quiet --manifest-path "$work/source/Cargo.toml" --format json --spec-version 1.5 --target all
    # Without the folder's own name.
    sed "s|file://$work/source|file:///tabray|g" "$work/source/tabray.cdx.json" > "$out/tabray-$version.cdx.json"
}

# Rays that are hard to decide, and what they hit, for scenes that need no other files: other tracers may be judged by them.
rays() {
    local folder=tabray-$version-hard-rays scene name
    files
    # With what scenes include.
    install -D -m644 -t "$out/$folder/parts" scenes/parts/studio.inc
    for scene in scenes/entities/{box,capsule,cylinder,disc,ellipsoid,lathe,polygon,prism,quadric,sphere,torus,triangle}.ray \
        scenes/models/{icosahedron.ply,knot.obj,slivers.obj}; do
        name=$(basename "${scene%.*}")
        install -D -m644 -t "$out/$folder/$(basename "$(dirname "$scene")")" "$scene"
        "$program" hard "$scene" -n 10000 -o "$out/$folder/$name-rays.csv"
        "$program" hits "$scene" "$out/$folder/$name-rays.csv" --tight -o "$out/$folder/$name-hits.csv" 2> /dev/null
    done
    archive "$folder"
}

for package in "${@:-linux aarch64 windows deb wheel web vscode container sbom rays}"; do
    for one in $package; do
        seconds=$SECONDS
        printf '== %s\n' "$one"
        "$one"
        echo "-- $((SECONDS - seconds)) s"
    done
done
rm -rf "$out/files"
(cd "$out" && sha256sum -- * > SHA256SUMS && ls -l)
