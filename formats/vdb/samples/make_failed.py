#!/usr/bin/env python3
"""Makes failed/ from passed/one-atom.vdb: one broken rule of VDBv1.md a file."""
import pathlib
import struct

here = pathlib.Path(__file__).parent
good = (here / "passed/one-atom.vdb").read_bytes()


def after(name, type_name):
    """Position of the value of a metadata entry."""
    key = name.encode() + struct.pack("<I", len(type_name)) + type_name.encode()
    return good.index(key) + len(key) + 4


def put(at, fmt, *values):
    return good[:at] + struct.pack(fmt, *values) + good[at + struct.calcsize(fmt):]


scale = good.index(b"UniformScaleTranslateMap") + 24 + 24
background = scale + 15 * 8 + 4



def with_tile(number, count):
    """The same file as a tile: three more metadata entries, behind which no length depends on them."""
    def text(t):
        return struct.pack("<I", len(t)) + t.encode()

    first = good.index(text("name") + text("string"))
    entries = [("tile", "int32", struct.pack("<i", number)), ("tiles", "int32", struct.pack("<i", count)),
               ("tile_digest", "int64", struct.pack("<q", 1))]
    more = b"".join(text(name) + text(kind) + struct.pack("<I", len(value)) + value for name, kind, value in entries)
    count_of_all = struct.unpack_from("<I", good, first - 4)[0] + len(entries)
    return good[:first - 4] + struct.pack("<I", count_of_all) + more + good[first:]


samples = {
    "R1-empty": b"",
    "R1-not-openvdb": b"PDB" + good[3:],
    "R2-version-300": put(8, "<I", 300),
    "R3-truncated": good[:-100],
    "R3-metadata-length": put(after("decay", "double") - 4, "<I", 0x7fffffff),
    "R4-other-name": good.replace(b"density", b"DENSITY", 1),
    "R4-integer-tree": good.replace(b"Tree_float_5_4_3", b"Tree_int32_5_4_3"),
    "R5-no-profile": good.replace(b"molmesh_profile", b"molmesh_profilE"),
    "R5-profile-2": put(after("molmesh_profile", "int32"), "<i", 2),
    "R6-no-isovalue": good.replace(b"isovalue", b"isovaluE"),
    "R6-atoms-double": good.replace(b"atoms\x05\0\0\0int64", b"atoms\x05\0\0\0int32"),
    "R7-isovalue-nan": put(after("isovalue", "double"), "<d", float("nan")),
    "R7-band-above-isovalue": put(after("band_lower", "double"), "<d", 1.05),
    "R8-one-point": put(after("grid_points", "vec3i"), "<i", 1),
    "R9-not-uniform": put(scale + 8, "<d", 2.0),
    "R10-background-1": put(background, "<f", 1.0),
    "R11-outside-the-grid": put(after("grid_points", "vec3i"), "<i", 2),
    "R12-a-tile-alone": with_tile(1, 2),
    "R12-tile-3-of-2": with_tile(3, 2),
}
for name, data in samples.items():
    assert data != good, name
    (here / "failed" / (name + ".vdb")).write_bytes(data)
