#!/usr/bin/env python3
"""bcif.py — writes model.bcif beside it: BinaryCIF with every encoding, by the description of the format alone."""
import os
import struct

def pack(v):
    if v is None:
        return b'\xc0'
    if isinstance(v, bool):
        return b'\xc3' if v else b'\xc2'
    if isinstance(v, int):
        return struct.pack('>B', v) if 0 <= v < 128 else b'\xd2' + struct.pack('>i', v)
    if isinstance(v, float):
        return b'\xcb' + struct.pack('>d', v)
    if isinstance(v, str):
        b = v.encode()
        return (struct.pack('>B', 0xa0 | len(b)) if len(b) < 32 else b'\xda' + struct.pack('>H', len(b))) + b
    if isinstance(v, bytes):
        return b'\xc5' + struct.pack('>H', len(v)) + v
    if isinstance(v, list):
        return b'\xdc' + struct.pack('>H', len(v)) + b''.join(map(pack, v))
    return b'\xde' + struct.pack('>H', len(v)) + b''.join(pack(k) + pack(w) for k, w in v.items())

TYPES = {'int8': (1, 'b'), 'int16': (2, 'h'), 'int32': (3, 'i'), 'uint8': (4, 'B'), 'uint16': (5, 'H'), 'uint32': (6, 'I'), 'float32': (32, 'f'), 'float64': (33, 'd')}

def array(values, kind):
    number, code = TYPES[kind]
    return {'data': struct.pack('<%d%s' % (len(values), code), *values), 'encoding': [{'kind': 'ByteArray', 'type': number}]}

def before(encoding, column):
    return {'data': column['data'], 'encoding': [encoding] + column['encoding']}

def runs(values):
    out = []
    for v in values:
        if out and out[-2] == v:
            out[-1] += 1
        else:
            out += [v, 1]
    return out

def run_length(values):
    return before({'kind': 'RunLength', 'srcType': 3, 'srcSize': len(values)}, array(runs(values), 'int32'))

def delta(values):
    steps = [values[i] - values[i - 1] if i else 0 for i in range(len(values))]
    return before({'kind': 'Delta', 'origin': values[0], 'srcType': 3}, array(steps, 'int32'))

def packed(values):
    out = []
    for v in values:
        while v > 126:
            out.append(127)
            v -= 127
        while v < -127:
            out.append(-128)
            v += 128
        out.append(v)
    return before({'kind': 'IntegerPacking', 'byteCount': 1, 'isUnsigned': False, 'srcSize': len(values)}, array(out, 'int8'))

def fixed(values, factor=1000):
    return before({'kind': 'FixedPoint', 'factor': factor, 'srcType': 33}, packed([round(v * factor) for v in values]))

def quantized(values, low, high, steps):
    return before({'kind': 'IntervalQuantization', 'min': low, 'max': high, 'numSteps': steps, 'srcType': 32},
                  array([round((v - low) / (high - low) * (steps - 1)) for v in values], 'uint16'))

def strings(values):
    different = []
    for v in values:
        if v not in different:
            different.append(v)
    text, offsets = ''.join(different), [0]
    for v in different:
        offsets.append(offsets[-1] + len(v))
    at = array(offsets, 'uint8')
    index = array([different.index(v) for v in values], 'int8')
    return {'data': index['data'], 'encoding': [{'kind': 'StringArray', 'dataEncoding': index['encoding'], 'stringData': text,
                                                 'offsetEncoding': at['encoding'], 'offsets': at['data']}]}

def column(name, data, mask=None):
    return {'name': name, 'data': data, 'mask': mask}

N = 6
SITE = [
    column('group_PDB', strings(['ATOM'] * 5 + ['HETATM'])), column('id', delta([1, 2, 3, 4, 5, 6])),
    column('type_symbol', strings(['N', 'C', 'C', 'O', 'N', 'ZN'])), column('label_atom_id', strings(['N', 'CA', 'C', "O5'", 'N', 'ZN'])),
    column('label_alt_id', strings([''] * N), array([1] * N, 'uint8')), column('label_comp_id', strings(['GLY'] * 4 + ['ALA', 'ZN'])),
    column('label_asym_id', strings(['A'] * 5 + ['B'])), column('label_seq_id', run_length([1, 1, 1, 1, 2, 0]), run_length([0, 0, 0, 0, 0, 1])),
    column('pdbx_PDB_ins_code', strings([''] * N), array([2] * N, 'uint8')),
    column('Cartn_x', fixed([0.001, 1.458, 2.009, -301.251, 3.332, 12.5])), column('Cartn_y', quantized([0, 1, 2, 3, 4, 0.5], 0, 4, 4001)),
    column('Cartn_z', array([0.1, -2.5, 3, 1e-3, 7.25, 100], 'float32')), column('occupancy', run_length([1] * N)),
    column('B_iso_or_equiv', array([1.5] * N, 'float64')), column('auth_seq_id', array([1, 1, 1, 1, 2, 300], 'uint16')),
    column('auth_asym_id', strings(['A-1'] * 5 + ['B']))]
CATEGORIES = [{'name': '_atom_site', 'rowCount': N, 'columns': SITE}, {'name': '_cell', 'rowCount': 1, 'columns': [column('length_a', array([10.0], 'float64'))]}]
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'model.bcif'), 'wb') as out:
    out.write(pack({'encoder': 'bcif.py', 'version': '0.3.0', 'dataBlocks': [{'header': 'X', 'categories': CATEGORIES}]}))
