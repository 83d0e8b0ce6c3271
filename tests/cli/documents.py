#!/usr/bin/env python3
"""documents.py BIN SOURCE GROUP [--record]: every command of the documents, run as it stands there.

GROUP: guide (README.md, docs/guide.md), tutorial (docs/tutorial.md), pages (docs/programs and all other pages).

The blocks of a page that are commands (indented by four blanks, or fenced) run in the page's order in one empty folder, with
BIN in PATH and MOLMESH set to SOURCE. Each has to end with status 0. Files of the reader's own, whose names begin with
capitals (MAP.map.gz), are small stand-ins made here; 1tii.pdb is a part of 1TII. A block whose commands begin with `$ ` is a session: what
follows a command is what it prints; … stands for any text, seconds for any seconds, and other numbers are right within 5 %, since processors differ. But where
the programs print one number twice (of 1,000 and more), as elements of a mesh, the page has one number there too: it is of one run. --record writes into the
page what the programs print, where more than seconds differs.
Besides, every option that a page names belongs to the program it names, every link leads somewhere, and every source
that a page names by its folder is there.

What is not on a machine (FreeFEM, meshio, OpenVDB) is skipped with a line. NOT_RUN lists the blocks that no test runs, and why.
"""
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

RECORD = sys.argv[4:] == ["--record"]
BIN, SOURCE, GROUP = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
PROGRAMS = {p: BIN / p for p in ("pdb2hier hierjoin hier2density density2tet tetsmooth tetstat tetlabel tetconvert tetreport "
                                 "density2map densityjoin map2density").split()}
PROGRAMS["molmesh-array"] = SOURCE / "tools/molmesh-array"
BEGINS = re.compile(r"(\$ |\w+=\S+ )*(" + "|".join(PROGRAMS) + r"|make|cmake|ctest|python3|printf|cat|mkdir|export|FreeFem\+\+|perf|"
                    r"valgrind|apt-get|apt|dpkg|docker|apptainer|conda|name=|tests/|docs/|\.ci/|build[-\w]*/)(\s|\b)")
GUIDE = "docs/guide.md"

# (page, beginning of a block): why no test runs it. A block that is no longer there is an error.
NOT_RUN = {
    ("README.md", "make -f Makefile.pipeline demo"): "installs packages and builds; `check` is how CI tests",
    (GUIDE, "make -f Makefile.pipeline deb"): "builds; the tests `install: Debian packages` and `install: Debian chroot`",
    (GUIDE, "make -f Makefile.pipeline demo"): "installs packages and builds",
    (GUIDE, "make -f Makefile.pipeline deb"): "builds and installs; the tests `install: Debian …` run it",
    (GUIDE, "cmake -S . -B build"): "builds; the test `install: example` runs the installation",
    (GUIDE, "molmesh-array -o meshes structures"): "needs Slurm: the test `cluster: job arrays on Slurm`",
    (GUIDE, "molmesh-array -o meshes big.cif.gz"): "needs Slurm: the test `cluster: job arrays on Slurm`; transcripts/pipeline.txt",
    (GUIDE, 'name=$(sed -n "${PBS_ARRAY_INDEX}p"'): "needs PBS or Grid Engine",
}
# Pages whose blocks are for developers: they build, or need other tools. Their options are checked.
BUILD_PAGES = {"CONTRIBUTING.md", "packaging/README.md", "tests/fuzz/README.md"}
# A command that may end with other statuses than 0.
STATUSES = {"hier2density --mode cuda": (0, 6), "tetsmooth --min-dihedral": (0, 5)}
# What a block needs that may not be on a machine: a word of it, and the command that says whether it is here.
NEEDS = {
    "FreeFem++": [SOURCE / "tests/solve/freefem.sh"],
    "freefem.sh": [SOURCE / "tests/solve/freefem.sh"],
    ".energy": [SOURCE / "tests/solve/freefem.sh"],
    "import meshio": ["python3", "-c", "import meshio"],
    "CLOUD.vdb": ["test", "-e", "CLOUD.vdb"],
}

failures = []


def fail(where, message):
    failures.append(f"{where}: {message}")
    print(f"FAILED  {failures[-1]}", flush=True)


def blocks(text):
    """(line, lines) of every block of code, without its indentation."""
    lines, i, found = text.split("\n"), 0, []
    while i < len(lines):
        fence = re.match(r" *```", lines[i])
        if fence:
            j = i + 1
            while j < len(lines) and not re.match(r" *```", lines[j]):
                j += 1
            found.append((i + 2, lines[i + 1:j]))
            i = j + 1
        elif re.match(r" {4,}\S", lines[i]) and (i == 0 or not lines[i - 1].strip()):
            j = i
            while j < len(lines) and (lines[j].startswith("    ") or not lines[j].strip()):
                j += 1
            block = lines[i:j]
            while not block[-1].strip():
                block.pop()
            indent = min(len(s) - len(s.lstrip()) for s in block if s.strip())
            found.append((i + 1, [s[indent:] for s in block]))
            i = j
        else:
            i += 1
    return found


# --- stand-ins for the reader's files

def write_part_of_1tii(path):
    """Some residues of every chain of 1TII and the site that the pages name: a twelfth of its atoms."""
    def kept(line):
        chain, residue = line[21], int(line[22:26])
        first, last = {"C": (195, 198), "D": (44, 61)}.get(chain, (42, 45))
        return first <= residue <= last
    lines = (SOURCE / "tests/data/1tii.pdb").read_text().splitlines(keepends=True)
    path.write_text("".join(s for s in lines if s[:6] not in ("ATOM  ", "HETATM", "TER   ") or s.startswith("ATOM") and kept(s)))


def write_slab(path):
    """A slab of carbon atoms, 45 Å wide and 30 Å thick, in the place of the bilayer of simulations."""
    with open(path, "w") as out:
        n = 0
        for x in range(40, 86, 5):
            for y in range(40, 86, 5):
                for z in range(40, 71, 5):
                    n += 1
                    out.write(f"ATOM  {n % 100000:5d}  C1  POP L{n // 50:4d}    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           C\n")


ASSEMBLY = """data_X
_entry.id X
_pdbx_struct_assembly.id 1
_pdbx_struct_assembly_gen.assembly_id 1
_pdbx_struct_assembly_gen.oper_expression 1,2
_pdbx_struct_assembly_gen.asym_id_list A,B
loop_
_pdbx_struct_oper_list.id
_pdbx_struct_oper_list.matrix[1][1]
_pdbx_struct_oper_list.matrix[1][2]
_pdbx_struct_oper_list.matrix[1][3]
_pdbx_struct_oper_list.vector[1]
_pdbx_struct_oper_list.matrix[2][1]
_pdbx_struct_oper_list.matrix[2][2]
_pdbx_struct_oper_list.matrix[2][3]
_pdbx_struct_oper_list.vector[2]
_pdbx_struct_oper_list.matrix[3][1]
_pdbx_struct_oper_list.matrix[3][2]
_pdbx_struct_oper_list.matrix[3][3]
_pdbx_struct_oper_list.vector[3]
1 1 0 0 0 0 1 0 0 0 0 1 0
2 1 0 0 20 0 1 0 0 0 0 1 0
loop_
_atom_site.group_PDB
_atom_site.id
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_comp_id
_atom_site.label_asym_id
_atom_site.label_seq_id
_atom_site.auth_asym_id
_atom_site.auth_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
ATOM 1 C CA ALA A 1 A 1 0 0 0
ATOM 2 C CA GLY B 1 B 1 6 0 0
"""


CLOUD = """import pyopenvdb
grid = pyopenvdb.FloatGrid()
grid.name = 'density'
grid.fill((0, 0, 0), (9, 9, 9), 1)
pyopenvdb.write('CLOUD.vdb', grids=[grid])"""


def shell(script, folder, name="setup"):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=ENVIRONMENT, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        fail(name, f"status {done.returncode}: {done.stdout.strip()}")


def prepare(page, folder):
    if page == "docs/tutorial.md":
        return
    write_part_of_1tii(folder / "1tii.pdb")
    if page in ("README.md",):
        return
    write_slab(folder / "MEMBRANE.pdb")
    shutil.copy(SOURCE / "tests/data/ion.pqr", folder / "X.pqr")
    (folder / "ENTRY.cif").write_text(ASSEMBLY)
    shell("""gzip ENTRY.cif
        pdb2hier -q --select '//D' 1tii.pdb -o MODEL.hier
        pdb2hier -q --select '//A' 1tii.pdb -o OTHER.hier
        cp MODEL.hier FILAMENT.hier
        hier2density -q --spacing 2 --band 0.01,1.1 MODEL.hier -o MODEL.vdb
        density2map -q MODEL.vdb -o MAP.map && gzip -k MAP.map""", folder, f"{page}: setup")
    if page == GUIDE:
        shell("pdb2hier -q --select '//D' 1tii.pdb | hier2density -q --spacing 3 | density2tet -q -o M.vtu; mkdir FOLDER; cp M.vtu FOLDER/a.vtu; "
              "mv M.vtu FOLDER/b.vtu", folder, f"{page}: setup")
        return
    shell("""pdb2hier -q 1tii.pdb -o 1tii.hier && hier2density -q --spacing 2 1tii.hier -o 1tii.vdb
        density2tet -q 1tii.vdb -o 1tii.tet.vtu && tetsmooth -q --density 1tii.vdb 1tii.tet.vtu -o 1tii.vtu
        tetlabel -q 1tii.vtu 1tii.hier -o 1tii.labels.vtu
        pdb2hier -q X.pqr -o X.hier && hier2density -q X.hier | density2tet -q -o X.vtu
        mkdir FOLDER && cp 1tii.vtu FOLDER/a.vtu && cp 1tii.vtu FOLDER/b.vtu
        for name in FILAMENT MEMBRANE PAIR; do printf 'join 1\\npiece MODEL.hier\\npiece OTHER.hier\\n' >$name.join; done
        printf 'join 1\\npiece MODEL.vdb\\npiece MODEL.vdb translate=60,0,0\\n' >LATTICE.join
        for name in A MAP ALL PORE; do cp MODEL.vdb $name.vdb; done
        for i in 1 2; do hier2density -q --spacing 2 --tile $i/2 MODEL.hier -o BIG.$i-of-2.tile; done
        tetconvert -q 1tii.vtu -o PART.msh""", folder, f"{page}: setup")
    subprocess.run(["python3", "-c", CLOUD], cwd=folder, env=ENVIRONMENT, capture_output=True)


# --- what a session prints

SECONDS = re.compile(r"\d+(\.\d+)? s\b")
NUMBER = re.compile(r"(?<![\w.])-?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?", re.I)


def same_line(found, expected, within=0.05, pairs=None):
    """pairs: numbers found, and the page's in their places."""
    found, expected = SECONDS.sub("# s", found.rstrip()), SECONDS.sub("# s", expected.rstrip())
    numbers = NUMBER.findall(expected)
    pattern = "".join("(" + NUMBER.pattern + ")" if i % 2 else ".*".join(map(re.escape, part.split("…")))
                      for i, part in enumerate(re.split("(" + NUMBER.pattern + ")", expected)))
    pattern = re.sub(r"(\\ )+", r"\\s+", pattern)  # columns may be as wide as they like
    match = re.fullmatch(pattern, found)
    if not match:
        return False
    for text, true in zip(match.groups(), numbers):
        a, b = float(text.replace(",", "")), float(true.replace(",", ""))
        if text != true and (abs(b) < 10 and re.fullmatch(r"-?\d", true) or abs(a - b) > within * abs(b)):
            return False
    if pairs is not None:
        pairs += zip(match.groups(), numbers)
    return True


def differences(found, expected, pairs):
    """None where the lines are the same; a line `…` stands for any number of lines."""
    found = [s for s in found if s.strip()]
    expected = [s for s in expected if s.strip()]
    i = 0
    while expected:
        want = expected.pop(0)
        if want.strip() == "…":
            if not expected:
                return None
            while i < len(found) and not same_line(found[i], expected[0]):
                i += 1
            continue
        if i == len(found) or not same_line(found[i], want, pairs=pairs):
            return want, found[i] if i < len(found) else "no further line"
        i += 1
    return None if i == len(found) else ("no further line", found[i])


page_numbers = {}  # (page, number that a program printed): the page's number there


def run_session(where, lines, folder):
    """A block of `$ command`, what it prints, and perhaps `? status`."""
    commands, recorded = [], {}
    for line in lines:
        if line.startswith("$ "):
            commands.append([line[2:], [], 0])
        elif line.startswith("? "):
            commands[-1][2] = int(line.split()[1])
        elif commands[-1][0].endswith("\\"):
            commands[-1][0] += "\n" + line
        else:
            commands[-1][1].append(line)
    for command, expected, status in commands:
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=ENVIRONMENT, text=True, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != status:
            fail(where, f"status {done.returncode}, expected {status}: {command}\n{done.stdout}")
            continue
        printed, pairs = done.stdout.rstrip().split("\n"), []
        apart = differences(printed, expected, pairs)
        if RECORD:
            kept = [next((e for e in expected if same_line(s, e, within=0)), s) for s in printed]
            if [s for s in kept if s.strip()] != [s for s in expected if s.strip()]:
                recorded[command] = kept
        elif apart:
            fail(where, f"{command}\n    the page      {apart[0]}\n    the program   {apart[1]}")
        for found, on_page in pairs if not RECORD else []:
            before = page_numbers.setdefault((where.split(":")[0], found), on_page)
            if before != on_page and float(found.replace(",", "")) >= 1000:
                fail(where, f"{command}\n    the page      {on_page}, and before {before}\n    the program   {found} both times")
    if recorded:
        record(SOURCE / where.split(":")[0], recorded)


def record(path, recorded):
    """Into a page: what these commands print."""
    text = path.read_text()
    for command, printed in recorded.items():
        old = re.search(r"^( +)" + re.escape("$ " + command.replace("\n", "\n    ")) + r"\n(?:\n*\1(?!\$ |\? ).*\n)*", text, re.M)
        text = text[:old.start()] + "".join(f"{old[1]}{s}".rstrip() + "\n" for s in ["$ " + command] + printed) + text[old.end():]
    path.write_text(text)


def run_block(where, text, folder):
    allowed = next((s for begin, s in STATUSES.items() if text.startswith(begin)), (0,))
    script = "set -eo pipefail; trap 'echo \"in: $BASH_COMMAND\"' ERR\n" + text
    done = subprocess.run(["bash", "-c", script], cwd=folder, env=ENVIRONMENT, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode not in allowed:
        fail(where, f"status {done.returncode}, expected {allowed[0]}\n{done.stdout.strip()[-1500:]}")


# --- options and links

def check_options(where, text):
    """Every option after a program's name, up to the end of that command, is the program's."""
    for match in re.finditer(r"(?<![\w/.-])(?:\S*/)?(" + "|".join(PROGRAMS) + r")((?:[ \t]+(?:'[^']*'|\"[^\"]*\"|[^\s|;&`]+))*)",
                             re.sub(r"[ \t]#\s.*", "", text)):
        words = re.sub(r"'[^']*'", "''", match[2]).split(" -- ")[0]
        for option in re.findall(r"(?<=\s)--[a-z][a-z0-9-]*", words):
            if option not in HELP[match[1]]:
                fail(where, f"{match[1]} has no option {option}")


def check_selections(text, folder):
    """Every selection of the guide's table finds atoms."""
    table = text[text.index("## Selections"):]
    selections = re.findall(r"^\| `([^`]+)` \|", table[:table.index("\n## ", 5)], re.M)
    if len(selections) < 10:
        fail(GUIDE, f"{len(selections)} selections in the table, expected ten and more")
    for selection in selections:
        option = ["-r", selection + " P_R=0.5"] if selection.startswith("around") else ["--select", selection]
        done = subprocess.run(["pdb2hier", "-q", *option, "1tii.pdb", "-o", "selected.hier"], cwd=folder, env=ENVIRONMENT, text=True,
                              stderr=subprocess.PIPE)
        if done.returncode:
            fail(f"{GUIDE}: selection {selection}", done.stderr)


def anchors(path):
    if path not in anchors.known:
        text = re.sub(r"```.*?```", "", path.read_text(), flags=re.S)
        titles = [re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", s) for s in re.findall(r"^#+ (.*)$", text, re.M)]
        anchors.known[path] = {re.sub(r"[^\w\- ]", "", s.lower()).replace(" ", "-") for s in titles}
    return anchors.known[path] | set(re.findall(r'<a (?:id|name)="([^"]+)"', path.read_text()))


anchors.known = {}


def check_links(page, path, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", text)):
        if re.match(r"\w+:", target):
            continue
        file, _, anchor = target.partition("#")
        there = (path.parent / file).resolve() if file else path
        if not there.exists():
            fail(page, f"a link to {target}, which is not there")
        elif anchor and there.suffix == ".md" and anchor not in anchors(there):
            fail(page, f"a link to {target}: no such heading")


def check_paths(page, text):
    """Every source that a page names by its folder is there: from the root, libcommon, include or tests."""
    for name in re.findall(r"`([\w.-]+/[\w./-]+\.(?:hpp|cpp|cu|cuh|py|sh))`", text):
        if "NAME" not in name and not any((SOURCE / base / name).exists() for base in ("", "libcommon", "include", "tests")):
            fail(page, f"names {name}, which is not there")


# --- pages

def check_page(page, work, kit=None):
    path = SOURCE / page
    text = path.read_text()
    check_links(page, path, text)
    check_paths(page, text)
    plain = text
    for number, block in blocks(text):
        for line in block:
            plain = plain.replace(line, "", 1) if line.strip() else plain
    for span in re.findall(r"`([^`]+)`", plain):
        check_options(page, span)
    folder = work / page.replace("/", "_")
    if kit:
        shutil.copytree(kit, folder)
    else:
        folder.mkdir()
        prepare(page, folder)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    count, used = 0, set()
    for number, lines in blocks(text):
        where, block = f"{page}:{number}", "\n".join(lines)
        if not (lines[0].startswith("$ ") or any(BEGINS.match(s) for s in lines)) or lines[0].startswith("usage"):
            continue
        check_options(where, re.sub(r"\\\n", " ", block))
        skipped = next((key for key in NOT_RUN if key[0] == page and block.startswith(key[1])), None)
        if skipped:
            used.add(skipped)
            continue
        if page in BUILD_PAGES or "[OPTIONS]" in block or "…" in block and "$ " not in block:
            continue
        missing = next((word for word, test in NEEDS.items() if word in block and
                        subprocess.run(test, cwd=folder, env=ENVIRONMENT, capture_output=True).returncode), None)
        if missing:
            print(f"SKIPPED {where}: {missing} is not here", flush=True)
            continue
        count += 1
        before_block = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        (run_session if lines[0].startswith("$ ") else lambda w, s, f: run_block(w, "\n".join(s), f))(where, lines, folder)
        took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before_block
        if took > 2:
            print(f"    {where}: {took:.1f} s", flush=True)
    if page == GUIDE:
        check_selections(text, folder)
    for key in NOT_RUN:
        if key[0] == page and key not in used:
            fail(page, f"no block begins '{key[1]}', which NOT_RUN lists")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if count:
        print(f"{page}: {count} blocks run, {after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime:.1f} s of processor time",
              flush=True)


ENVIRONMENT = {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEFILES", "SLURM_MEM_PER_NODE")}
ENVIRONMENT.update(PATH=f"{BIN}:{SOURCE}/tools:/usr/bin:{os.environ['PATH']}", MOLMESH=str(SOURCE), BIN=str(BIN), LC_ALL="C.UTF-8",
                   OMP_WAIT_POLICY="passive", OMP_NUM_THREADS=os.environ.get("OMP_NUM_THREADS", "2"), PYTHONDONTWRITEBYTECODE="1")
HELP = {name: subprocess.run([path, "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout for name, path in PROGRAMS.items()}
for name, text in HELP.items():
    HELP[name] = set(re.findall(r"--[a-z][a-z0-9-]*", text))
    if len(text.splitlines()) > 60 or not re.search(r"^ +" + name + " ", text[text.find("usage"):].split("\n", 1)[1], re.M):
        fail(f"{name} --help", "more than 60 lines, or without an example")


def main():
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        if GROUP == "guide":
            for page in ("README.md", GUIDE):
                check_page(page, work)
        elif GROUP == "tutorial":
            check_page("docs/tutorial.md", work)
        else:
            kit = work / "kit"
            kit.mkdir()
            prepare("docs/programs", kit)
            tracked = subprocess.run(["git", "-C", SOURCE, "ls-files", "*.md"], stdout=subprocess.PIPE, text=True).stdout.split()
            pages = tracked or [str(p.relative_to(SOURCE)) for d in (".", "docs", "docs/programs", "docs/theory", "formats/*")
                                for p in SOURCE.glob(d + "/*.md")]
            for page in sorted(pages):
                if page not in ("README.md", GUIDE, "docs/tutorial.md", "CHANGELOG.md") and not page.startswith("tests/bench"):
                    check_page(page, work, kit)
    print(f"{len(failures)} failures" if failures else "every command ran")
    sys.exit(bool(failures))


main()
