#!/usr/bin/env python3
"""mutated_files.py [-n N] [-j JOBS] BIN FOLDER… — real structures, damaged a little, through BIN/pdb2hier.

Each of N runs takes a file of the folders (up to 1 MB unpacked), damages it in one to eight places (a byte, a digit, a
run of bytes lost or doubled, a line moved, the end cut off; gzip files packed again, or damaged packed) and counts
the exit status. The n-th damage is the same in every run. Status 1 if any run ended otherwise than with 0 and a
.hier or 3 and one line on standard error, took over 20 s or 2 GiB: such an input is kept in FOLDER `mutated-found`."""
import argparse, collections, concurrent.futures, gzip, os, pathlib, random, resource, subprocess, sys, tempfile

LARGEST = 1 << 20
ODD = b"0123456789.-+ *\n\t'\"#;_AZaz\x00\xff"


def sources(folders):
    for folder in folders:
        for path in sorted(pathlib.Path(folder).iterdir()):
            name = path.name.removesuffix(".gz")
            if not name.endswith((".pdb", ".ent", ".cif", ".pqr", ".json")):
                continue
            data = path.read_bytes()
            packed = path.name.endswith(".gz")
            try:
                text = gzip.decompress(data) if packed else data
            except (OSError, EOFError):
                continue  # damaged already: tests/cli has it
            if len(text) <= LARGEST:
                yield name, text, packed


def damage(data, rng):
    data = bytearray(data)
    for _ in range(rng.randint(1, 8)):
        at = rng.randrange(len(data)) if data else 0
        kind = rng.randrange(6)
        if kind == 0:
            data[at:at + 1] = bytes([rng.randrange(256)])
        elif kind == 1:
            data[at:at + 1] = bytes([rng.choice(ODD)])
        elif kind == 2:
            del data[at:at + rng.randrange(200)]
        elif kind == 3:
            other = rng.randrange(len(data) + 1)
            data[at:at] = data[other:other + rng.randrange(200)]
        elif kind == 4 and rng.randrange(8) == 0:
            del data[at:]
        elif kind == 5:
            lines = bytes(data[at:at + 4000]).split(b"\n")
            rng.shuffle(lines)
            data[at:at + 4000] = b"\n".join(lines)
    return bytes(data)


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))


def run(task):
    number, name, text, packed, tool = task
    rng = random.Random(number)
    if not packed:
        data, ending = damage(text, rng), ""
    elif rng.randrange(4):
        data, ending = gzip.compress(damage(text, rng), 1), ".gz"
    else:
        data, ending = damage(gzip.compress(text, 1), rng), ".gz"
    with tempfile.TemporaryDirectory() as folder:
        given, made = pathlib.Path(folder, name + ending), pathlib.Path(folder, "x.hier")
        given.write_bytes(data)
        try:
            done = subprocess.run([tool, "-q", "-t", "1", given, "-o", made], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                  preexec_fn=limits, timeout=20)
            status, said = done.returncode, done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired:
            status, said = "timeout", ""
        good = (status == 0 and made.exists()) or (status == 3 and said.count("\n") == 1 and not made.exists())
        if not good:
            kept = pathlib.Path("mutated-found")
            kept.mkdir(exist_ok=True)
            pathlib.Path(kept, f"{number}-{name}{ending}").write_bytes(data)
    return status, good, f"{number}-{name}{ending}: {status}: {said.strip()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=20000)
    parser.add_argument("-j", type=int, default=os.cpu_count())
    parser.add_argument("bin")
    parser.add_argument("folders", nargs="+")
    options = parser.parse_args()
    files = list(sources(options.folders))
    if not files:
        sys.exit("no structure file in the folders")
    tool = os.path.join(options.bin, "pdb2hier")
    tasks = ((n, *files[n % len(files)], tool) for n in range(options.n))
    counts, bad = collections.Counter(), 0
    with concurrent.futures.ThreadPoolExecutor(options.j) as pool:
        for status, good, line in pool.map(run, tasks):
            counts[status] += 1
            if not good:
                bad += 1
                print(line)
    print(f"{len(files)} files, {options.n} runs, status:", dict(sorted(counts.items(), key=str)), f"{bad} not as asked")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
