#!/usr/bin/env bash
# deb.sh — the Debian packages: made by cpack and looked at; or, in a bare Debian 12, installed and run.
#
#   deb.sh packages BUILD SOURCE     no root needed
#   deb.sh chroot BUILD SOURCE       as root, with debootstrap and a mirror ($MOLMESH_MIRROR); some minutes
set -eu
kind=$1 build=$(realpath "$2") source=$(realpath "$3")
skip() { echo "SKIPPED: $1"; exit 77; }
fail() { echo "FAILED: $1"; exit 1; }
mirror=${MOLMESH_MIRROR:-http://deb.debian.org/debian}
for program in cpack dpkg-deb dpkg-shlibdeps file; do
  command -v $program >/dev/null || skip "needs $program (Debian: cmake dpkg-dev file)"
done
if [ "$kind" = chroot ]; then
  [ "${MOLMESH_TEST_CHROOT:-}" = yes ] || skip "a minute of work and 120 MB from a mirror: set MOLMESH_TEST_CHROOT=yes, as root"
  [ "$(id -u)" = 0 ] || skip "needs root"
  command -v debootstrap >/dev/null || skip "needs debootstrap (Debian: debootstrap)"
  grep -qs '^VERSION_CODENAME=bookworm' /etc/os-release || skip "needs packages that Debian 12 built"
fi

work=$(mktemp -d)
root=$work/root
clean() {
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf "$work"
}
trap clean EXIT
trap 'exit 1' INT TERM
(cd "$build" && cpack -B "$work/packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >"$work/log" 2>&1) || { cat "$work/log"; exit 1; }
programs=$(echo "$work"/packages/molmesh_*.deb) library=$(echo "$work"/packages/libmolmesh-dev_*.deb)
ls -l "$programs" "$library"

if [ "$kind" = packages ]; then
  dpkg-deb --info "$programs" | sed -n '/Depends/p'
  dpkg-deb --field "$programs" Depends | grep -q 'libc6 (' || fail "the programs' package does not name the C library"
  dpkg-deb -x "$programs" "$work/programs" && dpkg-deb -x "$library" "$work/library"
  cd "$work/programs/usr"
  for page in "$source"/docs/programs/*.md; do
    name=$(basename "$page" .md)
    for file in "bin/$name" "share/man/man1/$name.1.gz" "share/bash-completion/completions/$name"; do
      [ -s "$file" ] || fail "$file is not in the package"
    done
    ! readelf -S "bin/$name" | grep -E '\.debug_|\.symtab' || fail "$name: has symbols for debuggers"
    ! readelf -d "bin/$name" | grep -E 'R(UN)?PATH' || fail "$name: looks for libraries in a folder of its own"
  done
  for file in bin/molmesh-array share/man/man1/molmesh-array.1.gz share/molmesh/{Makefile.pipeline,complexes/membrane.sh,tests/solve/freefem.sh,tests/solve/poisson_boltzmann.edp,tests/data/4cup.pdb} share/doc/molmesh/{README.md,copyright,changelog.gz,docs/guide.md,examples/1tii.pdb,examples/4cup.pdb}; do
    [ -s "$file" ] || fail "$file is not in the package"
  done
  # Links between the documents hold as in the sources.
  find share/doc/molmesh/{README.md,docs,formats,packaging} -name '*.md' | while read -r page; do
    grep -oE '\]\([^):#]+\.(md|png)' "$page" | cut -c 3- | while read -r to; do
      [ -e "$(dirname "$page")/$to" ] || { echo "$page: names $to, which is not in the package"; exit 1; }
    done || exit 1
  done || exit 1
  version=$(dpkg-deb --field "$programs" Version)
  grep -qF "version = \"$version\"" "$source/packaging/conda/meta.yaml" || fail "packaging/conda/meta.yaml: has another version than $version"
  # The library is what cmake --install brings, with which install.sh builds the example.
  cmake --install "$build" --component library --prefix "$work/installed" >"$work/log" || { cat "$work/log"; exit 1; }
  rm -r "$work/library/usr/share/doc" && rmdir "$work/library/usr/share"
  diff -r "$work/installed" "$work/library/usr" || fail "the library's package is not what cmake installs"
  if command -v lintian >/dev/null; then
    lintian --allow-root --fail-on error "$programs" "$library" || fail "lintian found errors"
  else
    echo "not looked at by lintian, which is not here"
  fi
  exit 0
fi

debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/log" 2>&1 ||
  { tail -n 3 "$work/log"; skip "debootstrap got no Debian 12 from $mirror"; }
mount -t proc proc "$root/proc"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # starts no service
chmod +x "$root/usr/sbin/policy-rc.d"
cp "$work"/packages/*.deb "$root/tmp"
cp -L /etc/resolv.conf "$root/etc/"
[ ! -e /etc/apt/apt.conf ] || cp /etc/apt/apt.conf "$root/etc/apt/"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
inside apt-get -qq update
inside sh -c 'apt-get install -qq -y --no-install-recommends /tmp/molmesh_*.deb' >"$work/log" 2>&1 ||
  { tail "$work/log"; fail "apt-get cannot install the programs"; }
inside sh -c 'apt-get install -s --no-install-recommends /tmp/libmolmesh-dev_*.deb' >"$work/log" 2>&1 ||
  { tail "$work/log"; fail "apt-get cannot install the library"; }
inside apt-get install -qq -y --no-install-recommends man-db bash-completion >"$work/log" 2>&1 || { tail "$work/log"; exit 1; }
inside useradd -m -s /bin/bash user
echo "installed: $(inside dpkg -l | grep -c ^ii) packages in all"

cat >"$root/home/user/run" <<'END'
set -eu
cd
cp /usr/share/doc/molmesh/examples/1tii.pdb .
pdb2hier 1tii.pdb -o 1tii.hier
hier2density --spacing 2 1tii.hier -o 1tii.vdb
density2tet --region both 1tii.vdb -o 1tii.tet.vtu
tetsmooth --density 1tii.vdb 1tii.tet.vtu -o 1tii.vtu
tetstat 1tii.vtu
tetlabel 1tii.vtu 1tii.hier -o 1tii.labels.vtu
tetconvert 1tii.labels.vtu -o 1tii.xdmf
tetreport 1tii.labels.vtu -o 1tii.html --png 1tii.png
density2map 1tii.vdb -o 1tii.map
map2density --help >help
hierjoin --version
densityjoin --version
molmesh-array --help | head -n 3
mkdir made
make -s -f /usr/share/molmesh/Makefile.pipeline OUT=made HIER2DENSITY_FLAGS='--spacing 2' DENSITY2TET_FLAGS='--region both' all
cmp made/1tii.vtu 1tii.vtu
man hier2density | head -n 4 | grep hier2density
bash -ic '. /usr/share/bash-completion/bash_completion; _completion_loader hier2density; complete -p hier2density' 2>/dev/null
END
chroot "$root" su - user -c 'LC_ALL=C.UTF-8 bash run' || fail "the programs do not run there"
inside dpkg -V molmesh
inside apt-get purge -qq -y -o Dpkg::Use-Pty=0 molmesh >/dev/null
left=$(cd "$root" && find usr -name '*molmesh*' -o -name 'tetsmooth*')
[ -z "$left" ] || fail "removed, and yet there: $left"
echo "installed, run and removed"
