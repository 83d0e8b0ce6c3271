#!/usr/bin/env bash
# membrane.sh — the calcium pump SERCA in a membrane that the box cuts (figure 10 a to c of the paper): membrane.sh DATA OUT.
#
# The pump is PDB 1SU4, the membrane four copies of a simulated POPC bilayer (its cell is 81.395 Å wide), with its hydrogens.
# Exponents are the paper's: P_R 0.2 everywhere, P_C 0.8 for the lipids and 1.1 for the pump.
#
# Makes membrane.hier; membrane.exterior.vtu, the surroundings, which the membrane divides into two parts, and
# membrane.both.vtu, the box with pump and lipids; membrane.regions.vtu, the same with pump and membrane as regions of their own. Beside
# each: .labels.vtu (domain, chain, residue), .txt, .json.
. "$(dirname "$0")/common.sh"
needs paper/1su4.pdb.gz large/popc_bilayer.pdb.gz
points 209

pdb2hier -q -r '* P_R=0.2 P_C=1.1' "$data/paper/1su4.pdb.gz" -o pump.hier
pdb2hier -q --select '(POPC)' -r '* P_R=0.2 P_C=0.8' "$data/large/popc_bilayer.pdb.gz" -o popc.hier

# The mean direction of the pump's ten helices becomes z, their middle the origin, and so does the middle of the bilayer.
cat >membrane.join <<'END'
join 1
piece pump.hier domain=pump     matrix=0.92989,0,0.36784,-57.613,0.11395,0.95081,-0.28806,-19.342,-0.34975,0.30978,0.88415,13.839
piece popc.hier domain=membrane chains=_:POPC carve=0.4 lattice=2,2,1,81.395,81.395,0 translate=-91.395,-91.395,-51.93
END
hierjoin membrane.join -o membrane.hier
density membrane --decay "$decay" --spacing "$(spacing 180)"
box=-52,-50,-60,68,70,120
for region in exterior both; do
  mesh membrane membrane.$region --region $region --cavities fill --box $box
done

# Cells at the interface are small on any grid: a coarser one.
if asked membrane.regions; then
  points 105
  ln -f membrane.hier membrane.regions.hier
  density membrane.regions --decay "$decay" --spacing "$(spacing 180)"
  improve='--hier membrane.hier' mesh membrane.regions membrane.regions --region both --regions domain --hier membrane.hier --cavities fill --box $box
fi
