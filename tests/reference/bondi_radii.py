#!/usr/bin/env python3
"""bondi_radii.py PDB2HIER DATA — compares each atom of 30 structures, its radius above all, with what this script reads.

It knows the columns of PDB, the table of atoms of mmCIF and the radii of Bondi (1964) and Mantina et al. (2009) by itself.
Status 77 where the data is not there."""
import collections
import glob
import gzip
import os
import re
import subprocess
import sys

# A. Bondi, J. Phys. Chem. 68 (1964) 441, table I; then M. Mantina et al., J. Phys. Chem. A 113 (2009) 5806, table 12.
BONDI = dict(H=1.20, D=1.20, HE=1.40, C=1.70, N=1.55, O=1.52, F=1.47, NE=1.54, SI=2.10, P=1.80, S=1.80, CL=1.75, AR=1.88,
             AS=1.85, SE=1.90, BR=1.85, KR=2.02, TE=2.06, I=1.98, XE=2.16, LI=1.82, NA=2.27, MG=1.73, K=2.75, NI=1.63,
             CU=1.40, ZN=1.39, GA=1.87, PD=1.63, AG=1.72, CD=1.58, IN=1.93, SN=2.17, PT=1.75, AU=1.66, HG=1.55, TL=1.96,
             PB=2.02, U=1.86)
MANTINA = dict(BE=1.53, B=1.92, AL=1.84, CA=2.31, GE=2.11, RB=3.03, SR=2.49, SB=2.06, CS=3.43, BA=2.68, BI=2.07, PO=1.97,
               AT=2.02, RN=2.20, FR=3.48, RA=2.83)
RADIUS = {**MANTINA, **BONDI}
OTHERS = 2.0  # Å: --unknown


def opened(path):
    return gzip.open(path, 'rt', errors='replace') if path.endswith('.gz') else open(path, errors='replace')


def pdb_atoms(lines):
    for line in lines:
        if line.startswith('ENDMDL'):
            return
        if line.startswith(('ATOM  ', 'HETATM')):
            yield line[12:16].strip(), line[76:78].strip(), tuple(float(line[a:a + 8]) for a in (30, 38, 46))


def cif_atoms(lines):
    columns, first = [], None
    for line in lines:
        if line.startswith('_atom_site.'):
            columns.append(line.strip().split('.')[1])
        elif columns and line.startswith(('ATOM', 'HETATM')):
            words = [w[1:-1] if w[0] in '\'"' and len(w) > 1 else w
                     for w in re.findall(r"""'.*?'(?=\s)|".*?"(?=\s)|\S+""", line)]
            row = dict(zip(columns, words))
            first = first or row['pdbx_PDB_model_num']
            if row['pdbx_PDB_model_num'] != first:
                return
            name = row['label_atom_id']
            yield name, row['type_symbol'], tuple(float(row['Cartn_' + a]) for a in 'xyz')
        elif columns and line.startswith('#'):
            return


def hier_atoms(text):
    for line in text.splitlines():
        word = line.split()
        if word and word[0] == 'atom':
            yield re.sub('%([0-9A-F]{2})', lambda m: chr(int(m[1], 16)), word[1]), word[2], tuple(map(float, word[3:6])), float(word[6])


def main():
    pdb2hier, data = sys.argv[1:3]
    files = [f for folder in ('typical', 'paper', 'large') for f in sorted(glob.glob(f'{data}/{folder}/*'))
             if re.search(r'\.(pdb|cif)(\.gz)?$', f) and not re.search('dppc|popc|yiip|7cgo', f)]  # these have no elements, or are too many
    if not files:
        print('SKIPPED: no structures in', data)
        return 77
    files, wrong, atoms, elements = files[:30], 0, 0, collections.Counter()
    for path in files:
        with opened(path) as lines:
            read = cif_atoms(lines) if '.cif' in path else pdb_atoms(lines)
            expected = collections.Counter((name, element.upper(), xyz, RADIUS.get(element.upper(), OTHERS)) for name, element, xyz in read)
        run = subprocess.run([pdb2hier, '-q', '--waters', 'keep', '--altloc', 'all', path], stdout=subprocess.PIPE, text=True, check=True)
        got = collections.Counter((name, element.upper(), xyz, radius) for name, element, xyz, radius in hier_atoms(run.stdout))
        atoms += sum(expected.values())
        elements.update({e for _, e, _, _ in expected})
        if got != expected:
            wrong += 1
            print(path, 'missing', list((expected - got).items())[:3], 'more', list((got - expected).items())[:3])
    print(f'{len(files)} files, {atoms} atoms, {len(elements)} elements: {wrong} files differ')
    return wrong > 0 or len(files) < 30


sys.exit(main())
