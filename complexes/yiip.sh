#!/usr/bin/env bash
# yiip.sh — a zinc transporter in the membrane of its simulation, which the box cuts: yiip.sh DATA OUT.
#
# The simulated system of YiiP (a dimer, with hydrogens) in POPE and POPG. Its cell is a hexagonal prism, 102.845 Å wide: copies of the
# lipids around it close the membrane up to the walls. Exponents as in membrane.sh.
#
# Makes yiip.hier; yiip.exterior.vtu, the surroundings, which the membrane divides into two parts, and yiip.both.vtu, the box with
# protein and lipids; yiip.regions.vtu, the same with both as regions of their own. Beside each: .labels.vtu (domain, chain, residue),
# .txt, .json.
. "$(dirname "$0")/common.sh"
needs large/yiip_in_membrane.pdb.gz
points 209

pdb2hier -q --select '(!POPE,POPG)' -r '* P_R=0.2 P_C=1.1' "$data/large/yiip_in_membrane.pdb.gz" -o transporter.hier
pdb2hier -q --select '(POPE,POPG)' -r '* P_R=0.2 P_C=0.8' "$data/large/yiip_in_membrane.pdb.gz" -o lipids.hier

cat >yiip.join <<'END'
join 1
piece transporter.hier domain=transporter chains=_:YiiP
piece lipids.hier      domain=membrane    chains=_:lipid lattice=3,3,1,102.845,0,0,51.4225,89.066,0,0,0,1 translate=-154.2675,-89.066,0
END
hierjoin yiip.join -o yiip.hier
density yiip --decay "$decay" --spacing "$(spacing 155)"
box=-15,-3,-5,75,92,150
for region in exterior both; do
  mesh yiip yiip.$region --region $region --cavities fill --box $box
done

# Cells at the interface are small on any grid: a coarser one.
if asked yiip.regions; then
  points 105
  ln -f yiip.hier yiip.regions.hier
  density yiip.regions --decay "$decay" --spacing "$(spacing 155)"
  improve='--hier yiip.hier' mesh yiip.regions yiip.regions --region both --regions domain --hier yiip.hier --cavities fill --box $box
fi
