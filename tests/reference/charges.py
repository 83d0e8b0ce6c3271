#!/usr/bin/env python3
"""charges.py PDB2HIER DATA — is the sum of the charges in the .hier that of the PQR file?

On every file of DATA/pqr, and on what pdb2pqr makes of three proteins with AMBER, PARSE and CHARMM. Status 77 where the data is
not there; without pdb2pqr (Debian's package) its part is left out, and said."""
import glob
import gzip
import os
import shutil
import subprocess
import sys
import tempfile

PROTEINS = ('1ubq.pdb', '1aki.pdb', '1crn.pdb')


def pqr_charges(path):
    """Of the first model: the second last number of an atom's line, an element behind the radius left out."""
    with gzip.open(path, 'rt') if path.endswith('.gz') else open(path) as file:
        for line in file:
            if line.startswith('ENDMDL'):
                return
            if line.startswith(('ATOM', 'HETATM')):
                words = line.split()
                if words[-1][0].isalpha():
                    words.pop()
                yield float(words[-2])


def hier_charges(text):
    for line in text.splitlines():
        if line.startswith('atom'):
            words = line.split()
            yield float(words[7]) if len(words) > 7 else 0.


def compare(pdb2hier, path):
    made = subprocess.run([pdb2hier, '-q', '--surface', 'plain', '--waters', 'keep', path], capture_output=True, text=True, check=False)
    if made.returncode != 0:
        return f'status {made.returncode}: {made.stderr}'
    wanted, found = sum(pqr_charges(path)), sum(hier_charges(made.stdout))
    alone = sum(line.split()[6] == '0' for line in made.stdout.splitlines() if line.startswith('atom'))
    version = made.stdout.split('\n', 1)[0]
    print(f'{os.path.basename(path)}: {found:.4f} e, {alone} atoms of radius 0, {version}')
    if abs(wanted - found) > 1e-9:
        return f'found {found} e, expected {wanted} e'
    if (version == 'hier 2') != (alone > 0):
        return f'found {version} with {alone} atoms of radius 0'
    return None


def main():
    pdb2hier, data = sys.argv[1:]
    files = sorted(glob.glob(os.path.join(data, 'pqr', '*.pqr*'))) if data else []
    if not files:
        print('no data: set MOLMESH_TEST_DATA')
        return 77
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        pdb2pqr = shutil.which('pdb2pqr30') or shutil.which('pdb2pqr')
        if not pdb2pqr:
            print('pdb2pqr is missing (Debian: pdb2pqr): only the files of the data')
        for protein in PROTEINS if pdb2pqr else ():
            for force_field in ('AMBER', 'PARSE', 'CHARMM'):
                out = os.path.join(folder, f'{protein[:4]}.{force_field}.pqr')
                subprocess.run([pdb2pqr, f'--ff={force_field}', os.path.join(data, 'typical', protein), out],
                               capture_output=True, check=False)
                if os.path.exists(out):
                    files.append(out)
                else:
                    bad += 1
                    print(f'{out}: pdb2pqr made no file')
        for path in files:
            fault = compare(pdb2hier, path)
            if fault:
                bad += 1
                print(f'{path}: {fault}')
    print(f'{len(files)} files, {bad} bad')
    return 1 if bad else 0


sys.exit(main())
