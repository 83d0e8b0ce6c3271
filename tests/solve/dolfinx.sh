#!/usr/bin/env bash
# dolfinx.sh — prints the Python that has DOLFINx and meshio. Status 77: there is none.
for python in python3 /usr/bin/python3; do
  if "$python" -c 'import dolfinx, meshio' 2>/dev/null; then
    echo "$python"
    exit
  fi
done
echo "SKIPPED: no DOLFINx (Debian: python3-dolfinx-real python3-meshio)"
exit 77
