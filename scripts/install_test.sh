#!/usr/bin/env bash
# Installs the package of scripts/make_packages into a bare Debian in a folder, and solves and renders a scene there, by
# the program and by the Python module. Needs root and mmdebstrap.
#
# usage: scripts/install_test.sh [RELEASE]     such as bookworm, the default
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

release=${1:-bookworm}
package=$(ls build/packages/exitance_*.deb)
uri=$(apt-get indextargets --format '$(SITE)' "Created-By: Packages" | head -n 1)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

mmdebstrap --variant=minbase --mode=root "$release" "$folder/root" "$uri"
cp /etc/apt/apt.conf.d/* "$folder/root/etc/apt/apt.conf.d/"
cp "$package" "$folder/root/exitance.deb"
cat >"$folder/root/check.py" <<'PYTHON'
import exitance as ex
solution = ex.solve(ex.load("/room.obj"), error=0.1)
solution.render(size=(60, 40)).save("/python.png")
print(solution)
PYTHON
chroot "$folder/root" apt-get update -q
chroot "$folder/root" apt-get install -q -y /exitance.deb
chroot "$folder/root" sh -euc 'exitance generate office nx=1 ny=1 nfurn=2 books=3 -o /room.obj
    exitance solve /room.obj -o /room.h5 --error 0.1
    exitance render /room.h5 -o /room.png
    python3 /check.py
    test -s /room.png -a -s /python.png'
echo "installed and run on $release"
