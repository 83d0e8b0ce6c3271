#!/usr/bin/env bash
# machines.sh — three of the largest structures, with a part of each emphasized, cut into eight parts (figure 11 of the paper): machines.sh DATA OUT.
#
# PDB 4V6X, a ribosome, stands in for 2W4A: P_R 0.2 and P_C 0.8, the RNA of its small subunit 0.4 and 1.2. PDB 1HTQ, glutamine
# synthetase (one model, chain A placed on all 24): 0.3 and 0.8, chains A to C 1 and 1.5. PDB 2BTV, a capsid of 60 copies of 15 chains, stands in for
# 2KU2: 0.5 and 1, one copy 1.6 and 2.
#
# Makes ribosome.vtu, synthetase.vtu, capsid.vtu, the molecules alone; their array `part` has the eight parts of METIS. Beside
# each: .hier, .vdb, .labels.vtu (chain, residue), .txt, .json.
. "$(dirname "$0")/common.sh"
machine() { # NAME POINTS FILE OPTION…: of pdb2hier
  local name=$1 file=$3
  points "$2"
  shift 3
  asked "$name" || return 0
  [ -e "$data/$file" ] || { echo "$recipe: skipped $name, $data/$file is not there"; return; }
  pdb2hier "$@" "$data/$file" -o "$name.hier"
  density "$name" --decay "$decay" --grid "$points"
  mesh "$name" "$name" --adapt 0.4
}
machine synthetase 513 paper/1htq_24chains_model1_derived.pdb.gz -r '* P_R=0.3 P_C=0.8' -r '//A,B,C P_R=1 P_C=1.5'
machine ribosome 289 large/4v6x.cif.gz -r '* P_R=0.2 P_C=0.8' -r '//B2 P_R=0.4 P_C=1.2'
machine capsid 97 large/2btv.pdb.gz --assembly 1 -r '* P_R=0.5 P_C=1' -r '//A_1,B_1,C_1,D_1,E_1,F_1,G_1,H_1,I_1,J_1,P_1,Q_1,R_1,S_1,T_1 P_R=1.6 P_C=2'
