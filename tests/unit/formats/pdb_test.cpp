// pdb_test.cpp — what is read from PDB, mmCIF and mmJSON, what stays, and what is refused.
#include "formats/pdb/gunzip.hpp"
#include "formats/pdb/sha256.hpp"
#include "pdb_text.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <zlib.h>

using namespace molmesh;
using namespace molmesh::test;

namespace {

const std::string two_chains = pdb_atom(" N", "GLY", "A", 1, 1, "N") + pdb_atom(" CA", "GLY", "A", 1, 2, "C") +
                               pdb_atom(" CA", "ALA", "A", 2, 3, "C") + pdb_atom(" CA", "GLY", "B", 1, 4, "C");

std::string gzip(const std::string& text) {
  z_stream z{};
  REQUIRE(deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string out(deflateBound(&z, text.size()) + 64, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  REQUIRE(deflate(&z, Z_FINISH) == Z_STREAM_END);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

std::string cif_loop(const std::string& rows) {
  return "data_x\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_"
         "atom_site.label_alt_id\n"
         "_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_"
         "site.Cartn_y\n"
         "_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n_atom_site.auth_seq_id\n_atom_site."
         "auth_asym_id\n" +
         rows;
}

} // namespace

TEST_CASE("a PDB file becomes chains, residues and atoms with Bondi's radii") {
  const Converted c = convert(two_chains);
  CHECK(listing(c.hierarchy) == "A/GLY:1/N A/GLY:1/CA A/ALA:2/CA B/GLY:1/CA");
  CHECK(c.hierarchy.source == "x.pdb sha256:" + formats::sha256(two_chains));
  CHECK(c.hierarchy.atom[0].center == Vec3d{1, 0, 0});
  CHECK(c.hierarchy.atom[0].radius == 1.55);
  CHECK(c.hierarchy.names[c.hierarchy.atom[1].element] == "C");
  CHECK(std::isnan(c.hierarchy.atom[0].charge));
  CHECK(c.hierarchy.level[0].group[0].exponent == 1);
  CHECK(c.hierarchy.level[1].group[0].exponent == 0.3);
  CHECK(c.report.atoms == 4);
  CHECK(c.report.residues == 3);
  CHECK(c.report.chains == 2);
}

TEST_CASE("SHA-256 agrees with the examples of FIPS 180-4") {
  CHECK(formats::sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(formats::sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(formats::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST_CASE("gzip is read from its contents, in any number of members, and only whole") {
  const std::string zipped = gzip(two_chains);
  CHECK(convert(zipped).report.atoms == 4);
  const std::string half = two_chains.substr(0, 2 * 80 + 1);
  CHECK(formats::gunzip(gzip(half) + gzip(two_chains), "x") == half + two_chains);
  CHECK(formats::gunzip(zipped + std::string(512, '\0'), "x") == two_chains);
  CHECK(formats::gunzip(gzip(""), "x").empty());
  std::string damaged = zipped;
  damaged[damaged.size() - 6] ^= 1;
  CHECK(refusal(damaged).find("damaged") != std::string::npos);
  CHECK(refusal(zipped + "x").find("bytes after") != std::string::npos);
  for (size_t n = 2; n < zipped.size(); n += 7) {
    INFO(n);
    CHECK(refusal(zipped.substr(0, n)).substr(0, 7) == "x.pdb: ");
  }
}

TEST_CASE("coordinates that are no numbers are refused with file and line") {
  const auto with = [](const std::string& coordinates) {
    std::string line = pdb_atom(" CA", "GLY", "A", 1, 1, "C");
    return refusal(two_chains + line.replace(30, coordinates.size(), coordinates));
  };
  CHECK(with("********") == "x.pdb:5: found '********' in columns 31-38, expected a coordinate (Å)");
  CHECK(with("     nan") == "x.pdb:5: found '     nan' in columns 31-38, expected a coordinate (Å)");
  CHECK(with("     inf").substr(0, 8) == "x.pdb:5:");
  CHECK(with("        ").substr(0, 8) == "x.pdb:5:");
  CHECK(with("  1.0 2 ").substr(0, 8) == "x.pdb:5:");
  CHECK(refusal(two_chains.substr(0, two_chains.size() - 40)).substr(0, 8) == "x.pdb:4:");
  CHECK(refusal("").substr(0, 8) == "x.pdb:1:");
  CHECK(refusal("HEADER\nEND\n").substr(0, 8) == "x.pdb:2:");
  CHECK(refusal(std::string("HEADER\n\0", 8)).substr(0, 8) == "x.pdb:2:");
}

TEST_CASE("line ends, byte order marks and late columns do not matter") {
  const std::string expected = listing(convert(two_chains).hierarchy);
  std::string crlf, cr = two_chains, shifted;
  for (const char c : two_chains)
    crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  std::istringstream lines(two_chains);
  for (std::string line; std::getline(lines, line);)
    shifted += line.insert(30, " ") + "\n";
  for (const std::string& text :
       {crlf, cr, "\xEF\xBB\xBF" + two_chains, two_chains.substr(0, two_chains.size() - 1), shifted}) {
    const Converted c = convert(text);
    CHECK(listing(c.hierarchy) == expected);
    CHECK(c.hierarchy.atom[1].center == Vec3d{2, 0, 0});
  }
}

TEST_CASE("of alternative locations one conformer stays") {
  const std::string text =
      pdb_atom(" N", "SER", "A", 1, 0, "N") + pdb_atom(" CB", "SER", "A", 1, 1, "C", 'A', 0.4) +
      pdb_atom(" CB", "SER", "A", 1, 2, "C", 'B', 0.6) + pdb_atom(" OG", "SER", "A", 1, 3, "O", 'A', 0.4) +
      pdb_atom(" OG", "SER", "A", 1, 4, "O", 'B', 0.6) + pdb_atom(" CA", "SER", "A", 2, 5, "C", 'A', 0.5) +
      pdb_atom(" CA", "SER", "A", 2, 6, "C", 'B', 0.5);
  const auto kept = [&](const char* altloc) {
    formats::PdbOptions o;
    o.altloc = altloc;
    const Converted c = convert(text, o);
    std::string x;
    for (const Atom& a : c.hierarchy.atom)
      x += std::to_string(static_cast<int>(a.center.x));
    CHECK(c.report.altlocs == 7 - c.report.atoms);
    return x;
  };
  CHECK(kept("occupancy") == "0245"); // ties: the first
  CHECK(kept("first") == "0135");
  CHECK(kept("B") == "0246");
  CHECK(kept("C") == "0245");
  CHECK(kept("all") == "0123456");
}

TEST_CASE("where the sequence has alternatives, one residue stays") {
  const std::string text =
      pdb_atom(" CA", "SER", "A", 1, 1, "C", 'A', 0.3) + pdb_atom(" CA", "THR", "A", 1, 2, "C", 'B', 0.7) +
      pdb_atom(" CA", "GLY", "A", 2, 3, "C") + pdb_atom(" CA", "GLY", "A", 2, 4, "C", ' ', 1, 'A');
  CHECK(listing(convert(text).hierarchy) == "A/THR:1/CA A/GLY:2/CA A/GLY:2A/CA");
  // All of one conformer, then all of the other.
  CHECK(listing(
            convert(pdb_atom(" CA", "SER", "A", 1, 1, "C", 'A', 0.6) + pdb_atom(" CA", "GLY", "A", 2, 3, "C", 'A') +
                    pdb_atom(" CA", "THR", "A", 1, 2, "C", 'B', 0.4) + pdb_atom(" CA", "GLY", "A", 2, 4, "C", 'B'))
                .hierarchy) == "A/SER:1/CA A/GLY:2/CA");
}

TEST_CASE("waters, hydrogens, hetero atoms and selections drop what they say, and count it") {
  const std::string text = pdb_atom(" CA", "GLY", "A", 1, 1, "C") + pdb_atom(" HA", "GLY", "A", 1, 2, "H") +
                           pdb_atom("ZN", "ZN", "A", 2, 3, "ZN", ' ', 1, ' ', "HETATM") +
                           pdb_atom(" O", "HOH", "A", 3, 4, "O", ' ', 1, ' ', "HETATM") +
                           pdb_atom(" OW", "SOL", "", 4, 5, "O") + pdb_atom(" CA", "GLY", "", 5, 6, "C");
  formats::PdbOptions o;
  CHECK(listing(convert(text, o).hierarchy) == "A/GLY:1/CA A/GLY:1/HA A/ZN:2/ZN _/GLY:5/CA");
  CHECK(convert(text, o).report.waters == 2);
  o.hydrogens = false;
  o.hetatm = false;
  o.waters = true;
  CHECK(listing(convert(text, o).hierarchy) == "A/GLY:1/CA A/HOH:3/O _/SOL:4/OW _/GLY:5/CA");
  CHECK(convert(text, o).report.hydrogens == 1);
  CHECK(convert(text, o).report.hetatms == 1);
  o = {};
  o.select = "//A//[C]";
  CHECK(listing(convert(text, o).hierarchy) == "A/GLY:1/CA");
  CHECK(convert(text, o).report.unselected == 3);
  o.select = "//Q";
  CHECK(refusal(text, o) ==
        "x.pdb: found no atom that is kept (dropped: 2 of waters, 4 outside --select), expected at least one; "
        "chains here: A, _ (for example '//A', '//A/45-60', '//A/(HEM)')");
  o.select = "//A//[C";
  CHECK(refusal(text, o, "x.pdb", Status::usage).find("syntax") != std::string::npos);
}

TEST_CASE("models: the first, one by number, or all with unique chain names") {
  const std::string text = "MODEL        1\n" + pdb_atom(" CA", "GLY", "A", 1, 1, "C") +
                           "ENDMDL\nMODEL        7\n" + pdb_atom(" CA", "GLY", "A", 1, 2, "C") +
                           pdb_atom(" CA", "GLY", "B", 1, 3, "C") + "ENDMDL\nEND\n";
  formats::PdbOptions o;
  CHECK(listing(convert(text, o).hierarchy) == "A/GLY:1/CA");
  CHECK(convert(text, o).report.other_models == 2);
  o.model = "7";
  CHECK(listing(convert(text, o).hierarchy) == "A/GLY:1/CA B/GLY:1/CA");
  o.model = "all";
  CHECK(listing(convert(text, o).hierarchy) == "A_1/GLY:1/CA A_2/GLY:1/CA B/GLY:1/CA");
  o.model = "2";
  CHECK(refusal(text, o) == "x.pdb: found no model 2, expected one of 1, 7");
  o.model = "0";
  const std::string zeros = "MODEL     0000\n" + pdb_atom(" CA", "GLY", "A", 1, 1, "C") +
                            "ENDMDL\nMODEL     0012\n" + pdb_atom(" CA", "GLY", "A", 1, 2, "C") + "ENDMDL\n";
  CHECK(convert(zeros, o).hierarchy.atom[0].center.x == 1);
  o.model = "12";
  CHECK(convert(zeros, o).hierarchy.atom[0].center.x == 2);
}

TEST_CASE("mmCIF: so many models are refused before gemmi looks for each among all") {
  std::string text = "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.pdbx_PDB_model_num\n_atom_site.Cartn_x\n"
                     "_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  for (int m = 1; m <= 10000; ++m)
    text += "CA " + std::to_string(m) + " 1 2 3\n";
  CHECK(refusal(text) == "x.pdb:2: found more than 9999 models, expected fewer");
}

TEST_CASE("elements without a radius get the stated one, or are refused") {
  const std::string text = pdb_atom("FE", "HEM", "A", 1, 1, "FE") + pdb_atom(" Q1", "UNK", "A", 2, 1, " X");
  formats::PdbOptions o;
  o.unknown_radius = 1.25;
  const Converted c = convert(text, o);
  CHECK(c.hierarchy.atom[0].radius == 1.25);
  REQUIRE(c.report.unknown_elements.size() == 2);
  CHECK(c.report.unknown_elements.at("Fe").atoms == 1);
  CHECK(c.report.unknown_elements.at("X").first == "Q1 of UNK A/2");
  o.unknown_radius = 0;
  CHECK(refusal(text, o) == "x.pdb: found atom FE of HEM A/1, element Fe, expected an element with a radius");
}

TEST_CASE("elements that a PDB file leaves out come from the names") {
  const auto element = [](const std::string& name, const std::string& residue) {
    const Converted c = convert(pdb_atom(name, residue, "A", 1, 1, "  "));
    return c.hierarchy.names[c.hierarchy.atom[0].element];
  };
  CHECK(element(" CA", "ALA") == "C");
  CHECK(element("CA", "ALA") == "C");
  CHECK(element("CA", "CA") == "Ca");
  CHECK(element("1HB", "ALA") == "H");
  CHECK(element("HG11", "VAL") == "H");
  CHECK(element("OH2", "TP9") == "O");
  CHECK(element("SE", "MSE") == "Se");
  CHECK(element("P", "DA") == "P");
}

TEST_CASE("mmCIF: missing columns are filled in, bad coordinates have their line") {
  const std::string rows = "ATOM 1 N N . GLY A 1 1.0 0 0 1 10 1 X\nATOM 2 C CA . GLY A 1 2.5 0 0 1 10 1 X\n";
  const Converted c = convert(cif_loop(rows), {}, "x.cif");
  CHECK(listing(c.hierarchy) == "X/GLY:1/N X/GLY:1/CA");
  CHECK(c.hierarchy.atom[1].center.x == 2.5);
  CHECK(refusal(cif_loop(rows + "ATOM 3 C CB . GLY A 1 ? 0 0 1 10 1 X\n"), {}, "x.cif") ==
        "x.cif:20: found '?' as Cartn_x, expected a coordinate (Å)");
  CHECK(refusal(cif_loop(rows + "ATOM 3\n"), {}, "x.cif").substr(0, 6) == "x.cif:");
  CHECK(refusal("data_x\n_cell.length_a 1\n", {}, "x.cif") ==
        "x.cif:2: found no _atom_site category, expected mmCIF with atoms");
  const std::string minimal = "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_"
                              "atom_site.Cartn_z\nC1 1 2 3\n";
  CHECK(listing(convert(minimal).hierarchy) == "A/UNK:1/C1");
  const std::string single =
      "data_x\n_atom_site.label_atom_id C1\n_atom_site.Cartn_x 1\n_atom_site.Cartn_y 2\n_atom_site.Cartn_z 3\n";
  CHECK(convert(single).hierarchy.atom.at(0).center == Vec3d{1, 2, 3});
}

TEST_CASE("mmCIF: chains of many residues, and many chains, are read whole") {
  std::string rows, expected;
  int id = 0;
  const auto atom = [&](const std::string& name, const std::string& chain, int residue) {
    const std::string number = std::to_string(residue), serial = std::to_string(++id);
    rows += "HETATM " + serial + " O " + name + " . LIG W " + number + " " + serial + " 0 0 1 10 " + number + " " +
            chain + "\n";
  };
  constexpr int many = 2600;
  for (const char* name : {"O1", "O2"}) // a residue's atoms are far from each other in the file
    for (int residue = 1; residue <= many; ++residue)
      atom(name, "W", residue);
  for (int k = 1; k <= many; ++k)
    atom("O1", "'" + std::to_string(k) + "'", 1);
  atom("O1", "W", many + 1); // another part of it
  for (int residue = 1; residue <= many; ++residue)
    for (const char* name : {"O1", "O2"})
      expected += "W/LIG:" + std::to_string(residue) + "/" + name + " ";
  expected += "W/LIG:" + std::to_string(many + 1) + "/O1";
  for (int k = 1; k <= many; ++k)
    expected += " " + std::to_string(k) + "/LIG:1/O1";
  const Converted c = convert(cif_loop(rows), {}, "x.cif");
  CHECK(c.report.chains == many + 1);
  CHECK(c.report.residues == 2 * many + 1);
  CHECK((listing(c.hierarchy) == expected)); // not to be printed
}

TEST_CASE("mmCIF: what a chain of many residues has of each kind is told from all of it") {
  std::string rows;
  int id = 0;
  const auto residues = [&](const std::string& atom, const char* name, const char* label, int n) {
    for (int k = 0; k < n; ++k) {
      const std::string serial = std::to_string(++id);
      rows += "ATOM " + serial + " " + atom + " . " + name + " " + label + " . " + serial + " 0 0 1 10 " + serial +
              " A\n";
    }
  };
  residues("C CA", "GLY", "A", 1025); // the last of these alone would be no polymer
  residues("O O", "HOH", "B", 2000);
  const auto count = [&](const char* kind) {
    formats::PdbOptions o;
    o.select = kind;
    o.waters = true;
    return convert(cif_loop(rows), o, "x.cif").report.residues;
  };
  CHECK(count("*;polymer") == 1025);
  CHECK(count("*;solvent") == 2000);
}

TEST_CASE("mmJSON is the same structure") {
  const std::string json =
      R"({"data_X": {"atom_site": {"type_symbol": ["N", "C"], "label_atom_id": ["N", "CA"], "label_comp_id": ["GLY", "GLY"],
    "auth_asym_id": ["A", "A"], "auth_seq_id": [1, 1], "Cartn_x": [1.5, 2], "Cartn_y": [0, 0], "Cartn_z": [0, 0]}}})";
  const Converted c = convert(json, {}, "x.json");
  CHECK(listing(c.hierarchy) == "A/GLY:1/N A/GLY:1/CA");
  CHECK(c.hierarchy.atom[0].center.x == 1.5);
  CHECK(c.hierarchy.atom[0].radius == 1.55);
  for (const char* bad :
       {"{", "{}", "{\"a\": 1}", "{\"data_X\": 3}", "{\"data_X\": {\"atom_site\": {\"Cartn_x\": 3}}}",
        "{\"data_X\": {\"atom_site\": {\"Cartn_x\": []}}}",
        "{\"data_X\": {\"atom_site\": {\"Cartn_x\": [1], \"Cartn_y\": []}}}",
        "{\"data_X\": {\"atom_site\": {\"Cartn_x\": [[1]]}}}", "[]"}) {
    INFO(bad);
    CHECK(refusal(bad, {}, "x.json").substr(0, 6) == "x.json");
  }
}

TEST_CASE("the bundled structure has the counts of its header") {
  const std::string text = slurp(MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb");
  REQUIRE_FALSE(text.empty());
  const Converted c = convert(text, {}, "1tii.pdb");
  CHECK(c.report.atoms == 5469); // its ATOM records
  CHECK(c.report.chains == 7);   // COMPND: D, E, F, G, H, A, C
  CHECK(c.report.waters == 215);
  CHECK(convert(text, {}, "1tii.pdb").text == c.text);
}

TEST_CASE("a mutated structure is refused with one line, or read") {
  const std::string text = slurp(MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb").substr(0, 40'000);
  uint32_t seed = 2;
  const auto next = [&](size_t n) { return ((seed = seed * 1664525u + 1013904223u) >> 8) % n; };
  int refused = 0;
  for (int n = 0; n < 400; ++n) {
    std::string mutated = text;
    for (size_t k = 1 + next(6); k > 0; --k) {
      const size_t at = next(mutated.size());
      switch (next(5)) {
      case 0:
        mutated[at] = static_cast<char>(next(256));
        break;
      case 1:
        mutated.erase(at, next(100));
        break;
      case 2:
        mutated.insert(at, mutated.substr(next(mutated.size()), next(100)));
        break;
      case 3:
        mutated[at] = "0123456789.-+ *\n\tA"[next(18)];
        break;
      default:
        mutated.resize(at + 1);
      }
    }
    const std::string message = refusal(mutated);
    CHECK(message.find('\n') == std::string::npos);
    if (!message.empty())
      CHECK(message.rfind("x.pdb:", 0) == 0);
    refused += !message.empty();
  }
  CHECK(refused > 50);
  CHECK(refused < 350);
}
