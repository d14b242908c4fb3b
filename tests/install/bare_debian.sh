#!/usr/bin/env bash
# The Debian packages on a bare Debian 12: installed, a rope twisted by an ordinary user, moved and read-only, a program built
# against the libraries and run elsewhere, removed without a trace. As root, with debootstrap and a network; not a part of ctest. Arguments: a folder with the packages (`cd
# build/release && cpack`), a bare Debian 12, which is not changed (default, or "": one is made by debootstrap), and a folder with the package of an
# earlier version, from which the simulator is then upgraded.
set -euo pipefail
packages=$(realpath "$1") bare=${2:+$(realpath "$2")} earlier=${3:+$(realpath "$3")}
work=$(mktemp -d) root=
cleanup() {
  [ -z "$root" ] || ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf --one-file-system "$work"
}
trap cleanup EXIT
root=$work/debian
fail() { echo "bare_debian: $*" >&2; exit 1; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@" 2> "$work/errors" || fail "$*: $(tail -3 "$work/errors")"; }
# Runs a command as a user who has a home and no rights elsewhere.
as_user() { chroot --userspec=somebody "$root" env -i PATH=/usr/bin:/bin HOME=/home/somebody bash -ec "cd; $1"; }
# Every file, but for logs, caches and lists of apt and dpkg.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./run -o -path ./var/cache -o -path ./var/log -o -path ./var/lib/apt -o -path './var/lib/dpkg/*-old' \
    -o -path ./root/packages \) -prune -o -print) | sort
}

if [ -n "$bare" ]; then
  cp -a "$bare" "$root"
else
  debootstrap --variant=minbase bookworm "$root" >/dev/null
fi
cp /etc/resolv.conf "$root/etc/"
mount -t proc proc "$root/proc"
inside apt-get update -qq
inside useradd --create-home somebody
files > "$work/before"
inside dpkg-query -W > "$work/packages-before"

cat > "$root/home/somebody/seven.toml" <<'SCENE'
format = "ropewalk-scene-1"
parameters = "cnt-10-10-tersoff"
[rope]
tubes = 7
length_nm = 14
[twist]
moment_nN_nm = 5
rate_nN_nm_per_ps = 5
SCENE

# With an earlier version: a run that is done, and one that is half done.
if [ -n "$earlier" ]; then
  mkdir "$root/root/earlier"
  cp "$earlier"/ropewalk_*.deb "$root/root/earlier/"
  inside bash -c 'apt-get install -y -qq --no-install-recommends /root/earlier/ropewalk_*.deb' >/dev/null
  as_user 'ropewalk --version && ropewalk run seven.toml --out done --quiet && ropewalk run seven.toml --out half --until 1 --quiet' > "$work/said" 2>&1 ||
    fail "the earlier version: $(tail -3 "$work/said")"
  version=$(head -n 1 "$work/said" | grep -oE '[0-9]+\.[0-9]+\.[0-9]+' | head -n 1)
fi

mkdir "$root/root/packages"
cp "$packages"/*.deb "$root/root/packages/"
inside bash -c 'apt-get install -y -qq --no-install-recommends /root/packages/ropewalk_*.deb' >/dev/null
[ -z "$(find "$root/usr/lib" -name 'liblammps*')" ] || fail "the simulator alone has brought LAMMPS"
echo "installed: $(($(inside dpkg-query -W | wc -l) - $(wc -l < "$work/packages-before"))) packages for the simulator"

as_user 'ropewalk check seven.toml && ropewalk run seven.toml --out seven --quiet && ropewalk observe seven' > "$work/said" 2>&1 ||
  fail "an ordinary user's rope: $(tail -3 "$work/said")"
[ -s "$root/home/somebody/seven/report.html" ] || fail "the run left no report"

# Upgraded: runs of the earlier version are read, and go on, or are refused by the name of that version.
if [ -n "$earlier" ]; then
  printf 'format = "ropewalk-scene-1"\nparameters = "done/parameters.toml"\n[state]\nfile = "done/final.csv"\n[run]\nduration_ps = 1\n' > "$root/home/somebody/again.toml"
  as_user 'ropewalk observe done && ropewalk run again.toml --out again --quiet' > "$work/said" 2>&1 ||
    fail "runs of ropewalk $version: $(tail -3 "$work/said")"
  for verb in 'report done' 'compare done seven' 'picture done -o p.svg'; do
    as_user "ropewalk $verb" > "$work/said" 2>&1 || grep -q "ropewalk $version" "$work/said" || fail "$verb of ropewalk $version: $(tail -3 "$work/said")"
  done
  as_user 'ropewalk resume half --quiet' > "$work/said" 2>&1 || grep -q "was written by ropewalk $version" "$work/said" ||
    fail "going on with a run of ropewalk $version: $(tail -3 "$work/said")"
  echo "upgraded from $version; a run of it goes on: $(tail -n 1 "$work/said")"
  rm -rf "$root"/home/somebody/{done,half,again,again.toml,p.svg,compare.html} "$root/root/earlier"
fi

# Moved, and where nothing may be written.
mkdir -p "$root/opt/moved/bin" "$root/opt/moved/share"
cp "$root/usr/bin/ropewalk" "$root/opt/moved/bin/"
cp -r "$root/usr/share/ropewalk" "$root/opt/moved/share/"
chmod -R a-w "$root/opt/moved"
mv "$root/usr/share/ropewalk" "$root/usr/share/hidden"
as_user '/opt/moved/bin/ropewalk run seven.toml --out moved --quiet' > "$work/said" 2>&1 || fail "the moved tree: $(tail -3 "$work/said")"
mv "$root/usr/share/hidden" "$root/usr/share/ropewalk"
chmod -R u+w "$root/opt/moved"
rm -rf "$root/opt/moved"
tail -n 1 "$root/home/somebody/seven/log.csv" | cmp - <(tail -n 1 "$root/home/somebody/moved/log.csv") ||
  fail "the moved program has another result"

inside bash -c 'apt-get install -y -qq --no-install-recommends /root/packages/*.deb' >/dev/null
as_user 'ropewalk calibrate show cnt-10-10-tersoff --table && ropewalk validate run --tier quick wave-speeds' > "$work/said" 2>&1 ||
  fail "calibration and validation: $(tail -3 "$work/said")"
as_user 'ropewalk export seven.toml --lammps there && cd there && lmp-ropewalk -in in.rope && mpirun --oversubscribe -np 2 lmp-ropewalk -in in.rope && ropewalk import .' > "$work/said" 2>&1 ||
  fail "LAMMPS: $(tail -30 "$work/said")"

# A program of one's own, with what libropewalk-dev brings, a compiler and CMake.
inside apt-get install -y -qq --no-install-recommends cmake g++ make >/dev/null
cp -r "$(dirname "$0")/consumer" "$root/home/somebody/"
inside chown -R somebody: /home/somebody/consumer
as_user 'cmake -S consumer -B built -DCMAKE_BUILD_TYPE=Release && cmake --build built && mkdir elsewhere && mv built/twist elsewhere && rm -r built consumer && cd elsewhere && ./twist' > "$work/said" 2>&1 ||
  fail "a program of one's own: $(tail -3 "$work/said")"
grep -q "70 elements" "$work/said" || fail "a program of one's own has another rope: $(tail -3 "$work/said")"
inside apt-get purge -y -qq cmake g++ make >/dev/null

rm -rf "$root"/home/somebody/{elsewhere,seven,moved,there,validation,seven.toml}
inside apt-get purge -y -qq 'ropewalk*' libropewalk-dev >/dev/null
inside apt-get autoremove --purge -y -qq >/dev/null
inside dpkg-query -W | diff "$work/packages-before" - >&2 || fail "packages are left"
files | diff "$work/before" - > "$work/left" || true
grep -iE 'ropewalk' "$work/left" && fail "files of Ropewalk are left"
echo "removed; files that differ from those before, all of other packages: $(grep -c '^[<>]' "$work/left" || true)"
cat "$work/left"
