#!/usr/bin/env bash
# filament.sh — the thin filament of muscle in three levels (figures 1 and 4 of the paper): filament.sh DATA OUT.
#
# Stand-ins for PDB 2W4U: F-actin of 28 subunits, without hydrogens; tropomyosin is 56 pieces of a real helix (residues 740 to
# 778 of PDB 1SU4), two side by side, end to end along both grooves; troponin is four copies of lysozyme (PDB 1AKI).
#
# Makes filament.hier, with figure 1's exponents; filament.exterior.vtu, the box without the filament, and
# filament.both.vtu, the box with it; filament_blurred.vtu and filament_kept.vtu, the filament alone with figure 4's P_D.
# Beside each: .labels.vtu (domain, chain, residue at every triangle), .txt (tetstat), .json (run reports).
. "$(dirname "$0")/common.sh"
needs paper/actin_filament_28mer_for_2w4u_derived.pdb.gz paper/1su4.pdb.gz typical/1aki.pdb
points 513

pdb2hier -q --hydrogens drop "$data/paper/actin_filament_28mer_for_2w4u_derived.pdb.gz" -o actin.hier
pdb2hier -q "$data/typical/1aki.pdb" -o knob.hier
strand

# A strand is tilted as the groove is; the next one is 55 Å further and 27.2° round, as every second actin. The last step leads from one
# groove to the other.
cat >filament.join <<'END'
join 1
piece actin.hier  domain=actin       P_R=0.8 P_C=0.5 P_D=1
piece strand.hier domain=tropomyosin P_R=0.5 P_C=0.3 P_D=0.8 rotate=1,0,0,-19 translate=40,0,27.5 rotate=0,0,1,98 helix=14,55,27.2 helix=2,27.5,-166.4
piece knob.hier   domain=troponin    P_R=2   P_C=1   P_D=1   chains=A:Tn translate=34.4,-25,-0.2 rotate=0,0,1,197 translate=0,0,200 helix=2,385,190.4 helix=2,27.5,-166.4
rule //K P_R=2 P_C=1
END
hierjoin filament.join -o filament.hier
density filament --decay "$decay" --grid "$points"
mesh filament filament.exterior --adapt 0.4 --region exterior --box +40
mesh filament filament.both --adapt 0.4 --region both --box +40

hierjoin -q -r '* P_R=0.7 P_C=0.4 P_D=0.25' filament.join -o filament_blurred.hier
hierjoin -q -r '* P_R=0.7 P_C=0.4 P_D=0.25' -r '//K P_D=0.8' -r '//Tm_1,Tm_2 P_D=0.8' filament.join -o filament_kept.hier
for name in filament_blurred filament_kept; do
  density $name --decay "$decay" --grid "$points"
  mesh $name $name --adapt 0.4
done
