#!/usr/bin/env bash
# Makes the packages of a release from a clone: an archive with a program that needs no library of the system, and, where
# `cargo deb` is installed, a Debian package of the same program. Both bring the man pages and the completions.
#
#     bash docs/package.sh
#
# Needs `rustup target add x86_64-unknown-linux-musl`. Writes to target/package.
set -euo pipefail
cd "$(dirname "$0")/.."
# The manifest names the files of the Debian package by their folder.
unset CARGO_TARGET_DIR

target=x86_64-unknown-linux-musl
out=target/package
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
name=tabray-$version-x86_64-linux

cargo build --profile dist --locked --target "$target"
program=target/$target/dist/tabray

rm -rf "$out"
mkdir -p "$out/$name/completions" "$out/$name/man1"
install -s "$program" "$out/$name/tabray"
cp README.md LICENSE "$out/$name/"
"$program" man "$out/$name/man1" 2> /dev/null
gzip -9n "$out/$name"/man1/*.1
"$program" completions bash > "$out/$name/completions/tabray"
"$program" completions zsh > "$out/$name/completions/_tabray"
"$program" completions fish > "$out/$name/completions/tabray.fish"
cp -r scenes/gallery "$out/$name/scenes"

# The same order, owner and time of files make the same bytes of the same commit.
time=$(git log -1 --format=%ct 2> /dev/null || echo 0)
tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$time" -C "$out" -c "$name" | gzip -9n > "$out/$name.tar.gz"

if cargo deb --version > /dev/null 2>&1; then
    # The manifest does not know the version.
    ln -s "$name" "$out/files"
    cargo deb --quiet --locked --no-build --profile dist --target "$target" --output "$out/"
    rm "$out/files"
else
    echo "SKIPPED: cargo deb is not here" >&2
fi
ls -l "$out"/*.tar.gz "$out"/*.deb 2> /dev/null || true
