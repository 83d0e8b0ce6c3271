// bounds_test.cpp — memory and time of the readers follow the bytes of the file: a table of contrived inputs.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/mesh/read_mesh.hpp"
#include "formats/pdb/pdb.hpp"
#include "formats/tetstat/tetstat.hpp"
#include "formats/vdb/vdb.hpp"
#include "mesh/adjacency.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <sstream>
#include <streambuf>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

using namespace molmesh;

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

/// Memory and seconds would be the sanitizer's, not the code's.
bool measures_sanitizer() {
  if (sanitized)
    WARN("skipped: built with a sanitizer");
  return sanitized;
}

using Reader = std::function<void(std::istream&)>;

/// Reads, whether it is refused or not; false at any other end.
bool read_or_refuse(const Reader& read, const std::string& bytes) {
  std::istringstream in(bytes);
  try {
    read(in);
  } catch (const Error& e) {
    return e.status == Status::bad_input;
  }
  return true;
}

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Cost {
  int64_t memory = 0; ///< bytes at most, with all that is there before
  double seconds = 0; ///< of the processor: others may be at work
};
/// Of a process of its own that does this.
Cost cost(const std::function<bool()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      _exit(action() ? 0 : 1);
    } catch (...) {
      _exit(1);
    }
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  CHECK(status == 0);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return {usage.ru_maxrss * 1024, seconds(usage.ru_utime) + seconds(usage.ru_stime)};
}

/// Whether sixteen times the work takes at most 64 times the time. Quadratic would be 256; linear work is 16, but
/// seems up to three times as much where the small one fits the caches and the large one does not. Each is measured
/// again, and the shortest counts, where a busy machine may have been in the way.
struct Growth {
  double one = 1e9, sixteen = 1e9;
  bool is_linear() const { return sixteen < 64 * one + 0.1; }
};
Growth growth(const std::function<double()>& one, const std::function<double()>& sixteen) {
  Growth g;
  for (int i = 0; i < 10 && (i == 0 || !g.is_linear()); ++i) {
    g.one = std::min(g.one, one());
    g.sixteen = std::min(g.sixteen, sixteen());
  }
  return g;
}

void read_mesh(std::istream& in) {
  formats::MeshReading as;
  as.arrays = formats::CellArrays::keep;
  formats::MeshNotes notes;
  formats::read_mesh(in, "x", as, notes);
}
void read_hier(std::istream& in) {
  formats::read_hier(in, "x");
}
void read_vdb(std::istream& in) {
  formats::read_vdb(in, "x", 1);
}
/// Takes what is written and keeps nothing: the output is none of the reader's memory.
struct Nothing : std::streambuf {
  int overflow(int c) override { return c == EOF ? 0 : c; }
  std::streamsize xsputn(const char*, std::streamsize n) override { return n; }
};
/// And places the atoms; the name says the format.
void place_atoms(std::istream& in, const char* name) {
  Nothing nothing;
  std::ostream out(&nothing);
  formats::PdbHierarchy(in, name, {}).write(out);
}
void read_structure(std::istream& in) {
  place_atoms(in, "x.pdb");
}
void read_cif(std::istream& in) {
  place_atoms(in, "x.cif");
}
void read_gro(std::istream& in) {
  place_atoms(in, "x.gro");
}
void read_pqr(std::istream& in) {
  place_atoms(in, "x.pqr");
}
void read_xyzr(std::istream& in) {
  place_atoms(in, "x.xyzr");
}

std::string repeated(const std::string& text, size_t n) {
  std::string s;
  s.reserve(text.size() * n);
  for (size_t i = 0; i < n; ++i)
    s += text;
  return s;
}
/// line(0) + line(1) + …
std::string lines(size_t n, const std::function<std::string(size_t)>& line) {
  std::string s;
  for (size_t i = 0; i < n; ++i)
    s += line(i);
  return s;
}
std::string number(size_t n) {
  return std::to_string(n);
}

std::string zlib(const std::string& text) {
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
            text.size(), 9);
  packed.resize(size);
  return packed;
}
std::string gzip(const std::string& text) {
  z_stream z{};
  deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&z, text.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(packed.data());
  z.avail_out = static_cast<uInt>(packed.size());
  deflate(&z, Z_FINISH);
  packed.resize(z.total_out);
  deflateEnd(&z);
  return packed;
}

template <class T>
void put(std::string& s, T v) {
  char b[sizeof v];
  std::memcpy(b, &v, sizeof v);
  s.append(b, sizeof b);
}
void put_string(std::string& s, const std::string& text) {
  put(s, static_cast<uint32_t>(text.size()));
  s += text;
}
/// n values of a node, all the same, by zip.
void put_values(std::string& s, size_t n, float v) {
  std::string raw;
  for (size_t i = 0; i < n; ++i)
    put(raw, v);
  const std::string packed = zlib(raw);
  s += '\6'; // all of them
  put(s, static_cast<int64_t>(packed.size()));
  s += packed;
}

/// An OpenVDB file of nodes of 4096³ points that hold inside tiles of 128 points alone.
std::string vdb_of_tiles(size_t nodes) {
  std::string s;
  put(s, int64_t{0x56444220});
  put(s, uint32_t{224});
  put(s, uint64_t{0});
  s += '\0';
  s += std::string(36, '0');
  put(s, uint32_t{0}); // metadata
  put(s, int32_t{1});  // grids
  put_string(s, "density");
  put_string(s, "Tree_float_5_4_3");
  put_string(s, "");
  for (int i = 0; i < 3; ++i)
    put(s, int64_t{0});
  put(s, uint32_t{1}); // zip
  put(s, uint32_t{0}); // metadata
  put_string(s, "UniformScaleMap");
  for (int i = 0; i < 15; ++i)
    put(s, 1.0);
  put(s, int32_t{1}); // buffers
  put(s, 0.f);        // background
  put(s, uint32_t{0});
  put(s, static_cast<uint32_t>(nodes));
  std::string node(8192, '\0'); // no child, none active
  put_values(node, 32768, 2);
  for (size_t i = 0; i < nodes; ++i) {
    for (const size_t c : {i % 64, i / 64 % 64, i / 4096})
      put(s, static_cast<int32_t>(4096 * c));
    s += node;
  }
  return s;
}

const std::string msh_head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string four_points = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";
const std::string vtu_head =
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><UnstructuredGrid>";
const std::string vtu_cell =
    "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">"
    "0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3"
    "</DataArray><DataArray type=\"Int32\" Name=\"offsets\">4</DataArray><DataArray type=\"UInt8\" "
    "Name=\"types\">10</DataArray></Cells><CellData>";

const std::string cif_head = "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n"
                             "_atom_site.Cartn_z\n";

/// "name": n values, as many times `values` as there are.
std::string json_column(const std::string& name, size_t n, const std::string& values) {
  const size_t each = static_cast<size_t>(std::count(values.begin(), values.end(), ',')) + 1;
  return "\"" + name + "\":[" + values + repeated("," + values, n / each - 1) + "]";
}

/// A text of these letters, another one for each i below 62^size.
std::string letters(size_t i, size_t size) {
  static const std::string all = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  std::string s;
  for (size_t k = 0; k < size; ++k, i /= all.size())
    s += all[i % all.size()];
  return s;
}

/// MessagePack.
namespace pack {
void big_endian(std::string& s, uint64_t n, int bytes) {
  for (int b = bytes; b-- > 0;)
    s += static_cast<char>(n >> 8 * b);
}
std::string sized(char code, size_t n) {
  std::string s(1, code);
  big_endian(s, n, 4);
  return s;
}
std::string text(const std::string& t) {
  return sized('\xDB', t.size()) + t;
}
std::string bytes(const std::string& b) {
  return sized('\xC6', b.size()) + b;
}
std::string integer(size_t n) {
  return sized('\xD2', n);
}
std::string array(const std::vector<std::string>& elements) {
  std::string s = sized('\xDD', elements.size());
  for (const std::string& e : elements)
    s += e;
  return s;
}
std::string map(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string s = sized('\xDF', members.size());
  for (const auto& [key, value] : members)
    s += text(key) + value;
  return s;
}
} // namespace pack

const std::string int32s = pack::map({{"kind", pack::text("ByteArray")}, {"type", pack::integer(3)}}),
                  runs = pack::map({{"kind", pack::text("RunLength")}}),
                  steps = pack::map({{"kind", pack::text("Delta")}, {"origin", pack::integer(0)}});

std::string raw(const std::vector<int32_t>& numbers) {
  std::string s;
  for (const int32_t n : numbers)
    put(s, n);
  return s;
}
/// A column of n values, first, first + step, first + 2 step, …
std::string column_of_runs(const std::string& name, int32_t first, int32_t step, size_t n) {
  return pack::map({{"name", pack::text(name)},
                    {"data", pack::map({{"data", pack::bytes(raw({first, 1, step, static_cast<int32_t>(n) - 1}))},
                                        {"encoding", pack::array({steps, runs, int32s})}})}});
}
/// A column of n times the same text.
std::string column_of_text(const std::string& name, const std::string& text, size_t n) {
  const auto size = static_cast<int32_t>(text.size());
  return pack::map(
      {{"name", pack::text(name)},
       {"data", pack::map({{"data", pack::bytes(raw({0, static_cast<int32_t>(n)}))},
                           {"encoding", pack::array({pack::map({{"kind", pack::text("StringArray")},
                                                                {"dataEncoding", pack::array({runs, int32s})},
                                                                {"stringData", pack::text(text)},
                                                                {"offsetEncoding", pack::array({int32s})},
                                                                {"offsets", pack::bytes(raw({0, size}))}})})}})}});
}
std::string bcif(const std::string& category, size_t rows, const std::vector<std::string>& columns,
                 const std::string& more = "") {
  const std::string c = pack::map(
      {{"name", pack::text(category)}, {"rowCount", pack::integer(rows)}, {"columns", pack::array(columns)}});
  return pack::map(
      {{"encoder", pack::text(more)},
       {"version", pack::text("0.3.0")},
       {"dataBlocks", pack::array({pack::map({{"header", pack::text("X")}, {"categories", pack::array({c})}})})}});
}
/// n atoms; name: the text of all their names.
std::string bcif_atoms(size_t n, const std::string& name, const std::string& more = "") {
  return bcif("_atom_site", n,
              {column_of_text("label_atom_id", name, n), column_of_runs("Cartn_x", 0, 1, n),
               column_of_runs("Cartn_y", 0, 0, n), column_of_runs("Cartn_z", 0, 0, n),
               column_of_runs("auth_seq_id", 0, 1, n)},
              more);
}

/// An array of a .vtu, packed.
std::string vtu_array(const std::string& type, const std::string& name, const std::string& raw_values) {
  std::string head;
  for (const size_t n : {size_t{1}, raw_values.size(), raw_values.size(), zlib(raw_values).size()})
    put(head, static_cast<uint32_t>(n));
  const auto base64 = [](const std::string& s) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < s.size(); i += 3) {
      uint32_t bits = 0;
      for (size_t k = 0; k < 3; ++k)
        bits = bits << 8 | (i + k < s.size() ? static_cast<unsigned char>(s[i + k]) : 0u);
      for (size_t k = 0; k < 4; ++k)
        out += i + k > s.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return out;
  };
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"binary\">" + base64(head) +
         base64(zlib(raw_values)) + "</DataArray>";
}

struct Contrived {
  const char* name;
  Reader read;
  std::function<std::string(size_t)> bytes; ///< of a size
  size_t size;                              ///< some megabytes
};

const std::vector<Contrived> table = {
    {".msh: tetrahedra on the same points", read_mesh,
     [](size_t n) {
       return msh_head + four_points + "$Elements\n" + number(n) + "\n" +
              lines(n, [](size_t i) { return number(i + 1) + " 4 0 1 2 3 4\n"; }) + "$EndElements\n";
     },
     150000},
    {".msh: tetrahedra apart", read_mesh,
     [](size_t n) {
       return msh_head + "$Nodes\n" + number(4 * n) + "\n" +
              lines(4 * n,
                    [](size_t i) {
                      return number(i + 1) + " " + number(i % 2) + " " + number(i / 2 % 2) + " " + number(i / 4) +
                             "\n";
                    }) +
              "$EndNodes\n$Elements\n" + number(n) + "\n" +
              lines(n,
                    [](size_t i) {
                      return number(i + 1) + " 4 0 " + number(4 * i + 1) + " " + number(4 * i + 2) + " " +
                             number(4 * i + 3) + " " + number(4 * i + 4) + "\n";
                    }) +
              "$EndElements\n";
     },
     50000},
    {".msh: arrays of one value that is no integer", read_mesh,
     [](size_t n) {
       const std::string mesh = msh_head + four_points + "$Elements\n" + number(n) + "\n" +
                                lines(n, [](size_t i) { return number(i + 1) + " 4 0 1 2 3 4\n"; }) +
                                "$EndElements\n";
       return mesh + lines((8 * mesh.size() + (size_t{16} << 20)) / (4 * n), [](size_t i) {
                return "$ElementData\n1\n\"a" + number(i) + "\"\n0\n3\n0\n1\n1\n1 0.5\n$EndElementData\n";
              });
     },
     400000},
    {".msh: arrays without values", read_mesh,
     [](size_t n) {
       return msh_head + four_points + "$Elements\n" + number(n) + "\n" +
              lines(n, [](size_t i) { return number(i + 1) + " 4 0 1 2 3 4\n"; }) + "$EndElements\n" +
              lines(n / 10, [](size_t i) {
                return "$ElementData\n1\n\"a" + number(i) + "\"\n0\n3\n0\n1\n0\n$EndElementData\n";
              });
     },
     60000},
    {".mesh: tetrahedra on the same points", read_mesh,
     [](size_t n) {
       return "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra\n" +
              number(n) + "\n" + repeated("1 2 3 4 1\n", n) + "End\n";
     },
     300000},
    {".mesh: points that stand in one place", read_mesh,
     [](size_t n) {
       return "MeshVersionFormatted 2\nDimension 3\nVertices\n" + number(n) + "\n" + repeated("0 0 0 0\n", n) +
              "Tetrahedra\n1\n1 2 3 4 1\nEnd\n";
     },
     400000},
    {".vtk: cells on the same points", read_mesh,
     [](size_t n) {
       return "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 "
              "0 0 "
              "1\nCELLS " +
              number(n) + " " + number(5 * n) + "\n" + repeated("4 0 1 2 3\n", n) + "CELL_TYPES " + number(n) +
              "\n" + repeated("10\n", n);
     },
     250000},
    {".vtk: arrays of one cell", read_mesh,
     [](size_t n) {
       return "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 "
              "0 0 "
              "1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nCELL_DATA 1\nFIELD f " +
              number(n) + "\n" + lines(n, [](size_t i) { return "a" + number(i) + " 1 1 int\n1\n"; });
     },
     100000},
    {".vtk: arrays of no cell", read_mesh,
     [](size_t n) {
       return "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 "
              "0 0 1\nCELL_DATA 0\nFIELD f 2\na 1 0 int\nb 1 0 int\nFIELD f " +
              number(n - 2) + "\n" + lines(n - 2, [](size_t i) { return letters(i, 4) + " 1 0 int\n"; });
     },
     (size_t{1} << 20) + 1},
    {".vtu: arrays of the first piece alone", read_mesh,
     [](size_t n) {
       return vtu_head + vtu_cell +
              lines(
                  8 * n,
                  [](size_t i) { return "<DataArray type=\"Int8\" Name=\"a" + number(i) + "\">1</DataArray>\n"; }) +
              "</CellData></Piece>" + repeated(vtu_cell + "</CellData></Piece>\n", n) +
              "</UnstructuredGrid></VTKFile>\n";
     },
     10000},
    {".vtu: packed arrays of triangles", read_mesh,
     [](size_t n) {
       std::string corners("\0\1\2\3", 4), offsets, types("\xA"), values;
       put(offsets, uint32_t{4});
       put(values, 0.5);
       for (size_t i = 0; i < n; ++i) {
         corners += std::string("\0\1\2", 3);
         put(offsets, static_cast<uint32_t>(7 + 3 * i));
         types += '\5';
         put(values, 0.5);
       }
       std::string s = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                       "compressor=\"vtkZLibDataCompressor\"><!--" +
                       std::string(27 * n, 'x') +
                       "--><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"" + number(n + 1) +
                       "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1"
                       "</DataArray></Points><Cells>" +
                       vtu_array("UInt8", "connectivity", corners) + vtu_array("UInt32", "offsets", offsets) +
                       vtu_array("UInt8", "types", types) + "</Cells><CellData>";
       const std::string array = vtu_array("Float64", "@", values);
       const size_t at = array.find('@');
       for (size_t i = 0; i < 60; ++i)
         s += array.substr(0, at) + number(i) + array.substr(at + 1);
       return s + "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
     },
     300000},
    {".vtu: arrays of one cell", read_mesh,
     [](size_t n) {
       return vtu_head + vtu_cell +
              lines(
                  n,
                  [](size_t i) { return "<DataArray type=\"Int8\" Name=\"a" + number(i) + "\">1</DataArray>\n"; }) +
              "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
     },
     50000},
    {".vtu: texts", read_mesh,
     [](size_t n) {
       return vtu_head + "<FieldData>" +
              lines(n,
                    [](size_t i) {
                      return "<DataArray type=\"UInt8\" Name=\"a" + number(i) + "\">65</DataArray>\n";
                    }) +
              "</FieldData>" + vtu_cell + "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
     },
     50000},
    {".vtu: pieces", read_mesh,
     [](size_t n) {
       return vtu_head + repeated(vtu_cell + "</CellData></Piece>\n", n) + "</UnstructuredGrid></VTKFile>\n";
     },
     8000},
    {".vdb: tiles", read_vdb, vdb_of_tiles, 500},
    {".hier: levels", read_hier,
     [](size_t n) {
       return "hier 1\nlevels" + lines(n, [](size_t i) { return " l" + number(i); }) + "\n" +
              lines(n, [](size_t i) { return "l" + number(i) + " X 1\n"; }) + "atom A C 0 0 0 1\n";
     },
     100000},
    {".hier: levels without groups", read_hier,
     [](size_t n) { return "hier 1\nlevels" + lines(n, [](size_t i) { return " l" + letters(i, 4); }) + "\n"; },
     2000000},
    {".hier: groups of one atom", read_hier,
     [](size_t n) { return "hier 1\nlevels a\n" + repeated("a X 1\natom A C 0 0 0 1\n", n); }, 100000},
    {".hier: groups of one group, eight deep", read_hier,
     [](size_t n) {
       std::string one;
       for (const char level : {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'})
         one += std::string(1, level) + " X 1\n";
       return "hier 1\nlevels a b c d e f g h\n" + repeated(one + "atom A C 0 0 0 1\n", n);
     },
     100000},
    {".hier: bodies without atoms", read_hier,
     [](size_t n) { return "hier 2\nlevels a\n" + repeated("a X 1\nbody m sphere 0 0 0 3 1\n", n); }, 200000},
    {".hier: names", read_hier,
     [](size_t n) {
       return "hier 1\nlevels a\n" +
              lines(n, [](size_t i) { return "a " + number(i) + " 1\natom " + number(i) + " C 0 0 0 1\n"; });
     },
     1000000},
    {".hier: one long line", read_hier, [](size_t n) { return "hier 1\nsource " + std::string(n, 'x') + "\n"; },
     4000000},
    {".hier: atoms in one place", read_hier,
     [](size_t n) { return "hier 1\nlevels\n" + repeated("atom A C 0 0 0 1\n", n); }, 200000},
    {".xyzr: atoms in one place", read_xyzr, [](size_t n) { return repeated("0 0 0 1\n", n); }, 200000},
    {".pdb: atoms in one place", read_structure,
     [](size_t n) {
       return lines(n, [](size_t i) {
         const std::string residue = number(i / 10 % 9999 + 1);
         return "ATOM      1  C   ALA A" + std::string(4 - residue.size(), ' ') + residue +
                "       0.000   0.000   0.000\n";
       });
     },
     40000},
    {".cif: atoms of eight bytes", read_cif, [](size_t n) { return cif_head + repeated("C 0 0 0\n", n); }, 1500000},
    {".cif: atoms as they are deposited", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.label_comp_id\n_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n" +
              lines(n, [](size_t i) { return "CA 1.234 5.678 9.012 ALA A " + number(i / 5) + "\n"; });
     },
     400000},
    {".cif: a residue for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_seq_id\n" +
              lines(n, [](size_t i) { return "C 1.5 2.5 3.5 " + number(i) + "\n"; });
     },
     300000},
    {".cif: a name for each atom", read_cif,
     [](size_t n) { return cif_head + lines(n, [](size_t i) { return number(i) + " 0 0 0\n"; }); }, 600000},
    {".cif: a residue for each atom, whose number starts again", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.label_comp_id\n_atom_site.auth_seq_id\n" +
              lines(n, [](size_t i) { return "CA 1.23 4.56 7.89 ALA " + number(i % 2) + "\n"; });
     },
     400000},
    {".cif: a chain for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.label_comp_id\n_atom_site.auth_asym_id\n" +
              lines(n, [](size_t i) { return "CA 1.234 5.678 9.012 ALA A" + number(i) + "\n"; });
     },
     60000},
    {".cif: more chains than a file can hold", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_asym_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 A" + number(i) + "\n"; });
     },
     1500000},
    {".cif: one chain after the other, again and again", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n" + lines(n, [](size_t i) {
                return "C 1.234 5.678 9.012 " + number(i % 2) + " " + number(i / 4) + "\n";
              });
     },
     300000},
    {".cif: values that are not used", read_cif,
     [](size_t n) { return cif_head + "C 0 0 0\nloop_\n_x.y\n" + repeated("1\n", n); }, 4000000},
    {".cif: values that are used", read_cif,
     [](size_t n) { return cif_head + "C 0 0 0\nloop_\n_entity_poly_seq.num\n" + repeated("1\n", n); }, 4000000},
    {".cif: names and values", read_cif,
     [](size_t n) {
       return cif_head + "C 0 0 0\n" + lines(n, [](size_t i) { return "_a." + number(i) + " 1\n"; });
     },
     400000},
    {".cif: categories", read_cif,
     [](size_t n) {
       return cif_head + "C 0 0 0\n" + lines(n, [](size_t i) { return "_" + number(i) + ".b 1\n"; });
     },
     600000},
    {".cif: data blocks", read_cif,
     [](size_t n) {
       return cif_head + "C 0 0 0\n" + lines(n, [](size_t i) { return "data_" + number(i) + "\n"; });
     },
     200000},
    {".cif: two residues in turn, ten bytes an atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_seq_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + number(i % 2) + "\n"; });
     },
     1000000},
    {".cif: two chains in turn, ten bytes an atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_asym_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + number(i % 2) + "\n"; });
     },
     1000000},
    {".cif: two models in turn, ten bytes an atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.pdbx_PDB_model_num\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + number(i % 2) + "\n"; });
     },
     1000000},
    {".cif: alternatives of two residues in turn", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.label_alt_id\n_atom_site.auth_seq_id\n" + lines(n, [](size_t i) {
                return "C 0 0 0 " + std::string(i % 2 ? "A " : "B ") + number(i / 2 % 2) + "\n";
              });
     },
     800000},
    {".cif: an alternative of a residue for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.label_alt_id\n_atom_site.auth_seq_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 A " + number(i) + "\n"; });
     },
     600000},
    {".cif: a name of a residue for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_comp_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + number(i) + "\n"; });
     },
     600000},
    {".cif: a name of four letters for each atom", read_cif,
     [](size_t n) { return cif_head + lines(n, [](size_t i) { return letters(i, 4) + " 0 0 0\n"; }); }, 1000000},
    {".cif: a name of a residue of four letters for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_comp_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + letters(i, 4) + "\n"; });
     },
     1000000},
    {".cif: a chain of four letters for each atom", read_cif,
     [](size_t n) {
       return cif_head + "_atom_site.auth_asym_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 " + letters(i, 4) + "\n"; });
     },
     400000},
    {".cif: assemblies", read_cif,
     [](size_t n) {
       return cif_head +
              "C 0 0 0\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n"
              "_pdbx_struct_assembly_gen.oper_expression\n_pdbx_struct_assembly_gen.asym_id_list\n" +
              lines(n, [](size_t i) { return number(i) + " 1 A\n"; });
     },
     400000},
    {"BinaryCIF: atoms out of runs", read_cif, [](size_t n) { return bcif_atoms(n, "C"); }, 260000},
    {"BinaryCIF: atoms out of runs, in a large file", read_cif,
     [](size_t n) { return bcif_atoms(n, "C", std::string(10 * n, 'x')); }, 1000000},
    {"BinaryCIF: more atoms than a file can hold", read_cif, [](size_t n) { return bcif_atoms(n, "C"); },
     2000000000},
    {"BinaryCIF: a long text for each atom", read_cif,
     [](size_t n) { return bcif_atoms(200000, std::string(n, 'C')); }, 1000000},
    {"BinaryCIF: columns of runs", read_cif,
     [](size_t n) {
       return bcif("_entity", 200000, std::vector<std::string>(n, column_of_runs("id", 0, 1, 200000)));
     },
     10000},
    {"BinaryCIF: columns of a category with a long name", read_cif,
     [](size_t n) {
       return bcif("_" + std::string(100 * n, 'x'), 1, std::vector<std::string>(n, column_of_runs("id", 0, 0, 1)));
     },
     10000},
    {"BinaryCIF: values of one byte", read_cif,
     [](size_t n) {
       return pack::map({{"encoder", pack::sized('\xDD', n) + std::string(n, '\xC0')},
                         {"version", pack::text("0.3.0")},
                         {"dataBlocks", pack::array({})}});
     },
     990000},
    {"mmJSON: arrays of a category with a long name", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"" + std::string(100 * n, 'x') + "\":{\"a\":[0]" +
              lines(n, [](size_t i) { return ",\"" + number(i) + "\":[0]"; }) + "}}}";
     },
     20000},
    {"mmJSON: arrays of a category", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"entity\":{\"a\":[0]" +
              lines(n, [](size_t i) { return ",\"" + number(i) + "\":[0]"; }) + "}}}";
     },
     400000},
    {"mmJSON: categories", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"a\":{\"a\":[0]}" +
              lines(n, [](size_t i) { return ",\"" + number(i) + "\":{\"a\":[0]}"; }) + "}}";
     },
     400000},
    {".cif: entities in turn, whose subchains are named backwards", read_cif,
     [](size_t n) {
       return "data_x\nloop_\n_entity.id\n_entity.type\n" +
              lines(n, [](size_t i) { return number(i) + " polymer\n"; }) +
              "loop_\n_entity_poly.entity_id\n_entity_poly.type\n" +
              lines(n, [&](size_t i) { return number(n - 1 - i) + " other\n"; }) +
              "loop_\n_struct_asym.id\n_struct_asym.entity_id\n" +
              lines(n, [&](size_t i) { return "A" + number(i) + " " + number(n - 1 - i) + "\n"; }) +
              cif_head.substr(7) + "C 0 0 0\n";
     },
     60000},
    {".cif: entities and their subchains", read_cif,
     [](size_t n) {
       return "data_x\nloop_\n_entity.id\n_entity.type\n" +
              lines(n, [](size_t i) { return number(i) + " polymer\n"; }) +
              "loop_\n_struct_asym.id\n_struct_asym.entity_id\n" +
              lines(n, [](size_t i) { return "A" + number(i) + " 0\n"; }) + cif_head.substr(7) +
              "_atom_site.label_asym_id\n_atom_site.auth_asym_id\n" +
              lines(n, [](size_t i) { return "C 0 0 0 A" + number(i) + " A\n"; });
     },
     40000},
    {"mmJSON: atoms", read_cif,
     [](size_t n) {
       const auto column = [&](const char* name, const std::string& value) {
         return "\"" + std::string(name) + "\":[" + value + repeated("," + value, n - 1) + "]";
       };
       return "{\"data_x\":{\"atom_site\":{" + column("label_atom_id", "\"CA\"") + "," + column("Cartn_x", "1.25") +
              "," + column("Cartn_y", "2.25") + "," + column("Cartn_z", "3.25") + "}}}";
     },
     400000},
    {"mmJSON: two residues in turn", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"atom_site\":{" + json_column("label_atom_id", n, "0") + "," +
              json_column("Cartn_x", n, "0") + "," + json_column("Cartn_y", n, "0") + "," +
              json_column("Cartn_z", n, "0") + "," + json_column("auth_seq_id", n, "0,1") + "}}}";
     },
     1000000},
    {"mmJSON: two chains in turn", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"atom_site\":{" + json_column("label_atom_id", n, "0") + "," +
              json_column("Cartn_x", n, "0") + "," + json_column("Cartn_y", n, "0") + "," +
              json_column("Cartn_z", n, "0") + "," + json_column("auth_asym_id", n, "0,1") + "}}}";
     },
     1000000},
    {"mmJSON: one digit for all of an atom", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"atom_site\":{" + json_column("label_atom_id", n, "0") + "," +
              json_column("Cartn_x", n, "0") + "," + json_column("Cartn_y", n, "0") + "," +
              json_column("Cartn_z", n, "0") + "}}}";
     },
     1000000},
    {"mmJSON: values that are used", read_cif,
     [](size_t n) { return "{\"data_x\":{\"entity_poly_seq\":{" + json_column("num", n, "0") + "}}}"; }, 3000000},
    {"mmJSON: arrays in arrays", read_cif,
     [](size_t n) { return "{\"data_x\":{\"x\":{\"a\":[" + std::string(n, '[') + std::string(n, ']') + "]}}}"; },
     2000000},
    {".gro: atoms in one place", read_gro,
     [](size_t n) {
       return "x\n" + number(n) + "\n" + repeated("    1ALA     CA    1   0.000   0.000   0.000\n", n) + "1 1 1\n";
     },
     150000},
    {".pqr: a residue for each atom", read_pqr,
     [](size_t n) {
       return lines(n, [](size_t i) { return "ATOM 1 CA ALA A " + number(i % 100000) + " 0 0 0 0 1\n"; });
     },
     200000},
    {"mmJSON: values that are not used", read_cif,
     [](size_t n) {
       return "{\"data_x\":{\"x\":{\"a\":[0" + repeated(",0", n) +
              "]},\"atom_site\":{\"label_atom_id\":[\"C\"],\"Cartn_x\":[0],\"Cartn_y\":[0],\"Cartn_z\":[0]}}}";
     },
     3000000},
    {".xyzrn: a residue for each atom", read_xyzr,
     [](size_t n) { return lines(n, [](size_t i) { return "1.2 3.4 5.6 1.7 1 CA_ALA_" + number(i) + "\n"; }); },
     300000},
    {".xyzrn: two residues in turn", read_xyzr,
     [](size_t n) { return lines(n, [](size_t i) { return "0 0 0 1 1 C_A_" + number(i % 2) + "\n"; }); }, 500000},
    {".xyzrn: a name of a residue for each atom", read_xyzr,
     [](size_t n) { return lines(n, [](size_t i) { return "0 0 0 1 1 C_" + number(i) + "_1\n"; }); }, 400000},
    {".gro: a name of a residue for each atom", read_gro,
     [](size_t n) {
       return "x\n" + number(n) + "\n" +
              lines(n,
                    [](size_t i) {
                      const std::string residue = number(10000 + i % 90000);
                      return "    1" + residue + "    C    10.0.0.\n";
                    }) +
              "1 1 1\n";
     },
     200000},
    {".pdb: sequences of many chains", read_structure,
     [](size_t n) {
       return lines(n,
                    [](size_t i) {
                      return "SEQRES   1 " + std::string(1, static_cast<char>('A' + i % 26)) + "   13  ALA" +
                             repeated(" GLY", 12) + "\n";
                    }) +
              repeated("HETATM    1  C   GLX A   1       0.000   0.000   0.000\n", n);
     },
     20000},
    {".pqr: two residues in turn", read_pqr,
     [](size_t n) { return lines(n, [](size_t i) { return "ATOM 1 C " + number(i % 2) + " 0 0 0 0 1\n"; }); },
     300000},
    {".pqr: a chain for each atom", read_pqr,
     [](size_t n) { return lines(n, [](size_t i) { return "ATOM 1 C ALA A" + number(i) + " 1 0 0 0 0 1\n"; }); },
     150000},
    {".pdb: a chain for each atom", read_structure,
     [](size_t n) {
       return lines(n, [](size_t i) {
         return "ATOM      1  C   ALA " + std::string(1, static_cast<char>('A' + i % 26)) +
                "   1       0.000   0.000   0.000\n";
       });
     },
     150000},
    {"gzip of zeros", read_structure, [](size_t n) { return gzip(std::string(n, '\0')); }, 200000000},
};

} // namespace

TEST_CASE("readers: memory is at most 20 times the bytes of the file beyond 64 MB, whatever it says, and sixteen "
          "times the file takes at most 64 times the time",
          "[slow]") {
  if (measures_sanitizer())
    return;
  for (const Contrived& c : table) {
    const std::string small = c.bytes(c.size / 16), large = c.bytes(c.size);
    const Cost before = cost([] { return true; });
    int64_t memory = 0;
    const auto seconds = [&](const std::string& bytes) {
      const Cost of_reading = cost([&] { return read_or_refuse(c.read, bytes); });
      memory = std::max(memory, of_reading.memory - before.memory);
      return of_reading.seconds - before.seconds;
    };
    const Growth g = growth([&] { return seconds(small); }, [&] { return seconds(large); });
    INFO(c.name << ": " << large.size() << " bytes, " << memory << " of memory, " << g.one << " s, " << g.sixteen
                << " s");
    CHECK(memory <= 20 * static_cast<int64_t>(large.size()) + (int64_t{64} << 20));
    CHECK(g.is_linear());
  }
}

TEST_CASE("tetstat: sixteen times the regions take at most 64 times the time", "[slow]") {
  if (measures_sanitizer())
    return;
  const auto report = [](int n) {
    TetMesh m; // tetrahedra apart, each a region
    for (int32_t i = 0; i < n; ++i) {
      const double y = 2 * (i % 100), z = 2 * (i / 100); // no two behind each other along x
      for (const Vec3d& p : {Vec3d{0, y, z}, Vec3d{1, y, z}, Vec3d{0, y + 1, z}, Vec3d{0, y, z + 1}})
        m.point.push_back(p);
      m.tet.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
      m.region.push_back(i + 1);
    }
    rebuild_triangles(m);
    return formats::report_mesh(m, "x", {}, check_validity(m, 1), {}, 1);
  };
  const auto work = [&](int n) {
    const formats::MeshReport r = report(n);
    CHECK(r.validity.region.size() == static_cast<size_t>(n));
    CHECK(formats::compare_text(r, r).size() > static_cast<size_t>(100 * n));
    CHECK(formats::tetstat_json(r).size() > static_cast<size_t>(1000 * n));
  };
  const auto seconds = [&](int n) {
    const double start = processor_seconds();
    work(n);
    return processor_seconds() - start;
  };
  const Growth g = growth([&] { return seconds(625); }, [&] { return seconds(10000); });
  INFO(g.one << " s, " << g.sixteen << " s");
  CHECK(g.is_linear());
}

TEST_CASE("BinaryCIF that stands for more than its bytes allow is refused with one line") {
  const auto said = [](const std::string& bytes) {
    std::istringstream in(bytes);
    try {
      read_cif(in);
    } catch (const Error& e) {
      CHECK(e.status == Status::bad_input);
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(said(bcif_atoms(1000, "C")).empty());
  const size_t bytes = bcif_atoms(1, "C").size(), most = bytes / 3 + 262144;
  CHECK(said(bcif_atoms(most, "C")).empty());
  CHECK(said(bcif_atoms(most + 1, "C")) == "x.cif: found a category '_atom_site' of " + number(most + 1) +
                                               " rows in a file of " + number(bytes) +
                                               " bytes, expected BinaryCIF");
  const std::string long_names = bcif_atoms(1000, std::string(1000000, 'C'));
  CHECK(said(long_names) == "x.cif: found values that are over " +
                                number(20 * long_names.size() + (size_t{64} << 20)) +
                                " bytes of text, 20 times the file's and 64 MiB, expected BinaryCIF");
  CHECK(said(bcif("_atom_site", 3,
                  {column_of_text("label_atom_id", "C", 2), column_of_runs("Cartn_x", 0, 1, 3),
                   column_of_runs("Cartn_y", 0, 0, 3), column_of_runs("Cartn_z", 0, 0, 3)})) ==
        "x.cif: found a column of 2 rows in a category of 3, expected BinaryCIF");
  CHECK(said(bcif("_atom_site", 3,
                  {column_of_text("label_atom_id", "C", 3), column_of_runs("Cartn_x", 0, 1, 4),
                   column_of_runs("Cartn_y", 0, 0, 3), column_of_runs("Cartn_z", 0, 0, 3)})) ==
        "x.cif: found a run longer than its column, expected BinaryCIF");
}

TEST_CASE("an assembly of mmCIF has at most 100000 operators in all, and the message lists 1000 others") {
  const auto said = [](const std::string& rows) {
    std::istringstream in(cif_head +
                          "C 0 0 0\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n"
                          "_pdbx_struct_assembly_gen.oper_expression\n"
                          "_pdbx_struct_assembly_gen.asym_id_list\n" +
                          rows +
                          "loop_\n_pdbx_struct_oper_list.id\n_pdbx_struct_oper_list.matrix[1][1]\n"
                          "_pdbx_struct_oper_list.matrix[1][2]\n_pdbx_struct_oper_list.matrix[1][3]\n"
                          "_pdbx_struct_oper_list.vector[1]\n_pdbx_struct_oper_list.matrix[2][1]\n"
                          "_pdbx_struct_oper_list.matrix[2][2]\n_pdbx_struct_oper_list.matrix[2][3]\n"
                          "_pdbx_struct_oper_list.vector[2]\n_pdbx_struct_oper_list.matrix[3][1]\n"
                          "_pdbx_struct_oper_list.matrix[3][2]\n_pdbx_struct_oper_list.matrix[3][3]\n"
                          "_pdbx_struct_oper_list.vector[3]\nX 1 0 0 0 0 1 0 0 0 0 1 0\n");
    formats::PdbOptions options;
    options.assembly = "1";
    try {
      formats::PdbHierarchy(in, "x.cif", options);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string many = "(X" + repeated(",X", 299) + ")";
  CHECK(said("1 " + many + " A\n").empty());
  CHECK(said("1 " + many + many + " A\n").empty());
  CHECK(said(repeated("1 " + many + many + " A\n", 2)) ==
        "x.cif: assembly 1: found more than 100000 operators, expected fewer");
  const std::string others = said(lines(2000, [](size_t i) { return "a" + number(i) + " X A\n"; }));
  CHECK(others.find("expected one of a0, a1, ") != std::string::npos);
  CHECK(others.find("a999") == others.size() - 4);
}

TEST_CASE("a .vdb of voxels or places that no structure has is refused with the rule") {
  // The transform of vdb_of_tiles() is the last doubles before the tree; its scale the first of them.
  const auto with = [](double scale, double translation) {
    std::string s = vdb_of_tiles(0);
    const size_t at = s.find("UniformScaleMap") - 4;
    std::string tail = s.substr(at + 4 + 15 + 15 * 8), head = s.substr(0, at);
    put_string(head, "UniformScaleTranslateMap");
    for (int i = 0; i < 3; ++i)
      put(head, translation);
    for (int i = 0; i < 15; ++i)
      put(head, scale);
    head += tail;
    std::istringstream in(head);
    try {
      formats::read_vdb(in, "x", 1);
    } catch (const Error& e) {
      CHECK(e.status == Status::bad_input);
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(with(1e300, 0) == "x: R9: voxels of 1e+300 Å, expected 1e-6 to 1e6");
  CHECK(with(1e-300, 0) == "x: R9: voxels of 1e-300 Å, expected 1e-6 to 1e6");
  CHECK(with(1, 1e15) == "x: R9: a translation of 1e+15 Å, expected at most 1e8 in magnitude");
  CHECK(with(1, std::numeric_limits<double>::quiet_NaN()).find("x: R9: a translation of ") == 0);
  CHECK(with(1, 100).find("R9") == std::string::npos);
}
