// html.cpp — decides how much of each mesh the page can hold, compresses it, and puts the page together.
#include "formats/html/html.hpp"
#include "base/grouped.hpp"
#include "formats/html/embedded.hpp"
#include "formats/html/facts.hpp"
#include "formats/html/mesh_code.hpp"
#include "par/par.hpp"
#include "picture/colours.hpp"
#include <algorithm>
#include <cstdio>
#include <new>
#include <ostream>
#include <zlib.h>

namespace molmesh::formats {
namespace {

constexpr size_t worst_shown = 24;
/// Bytes of base64 that a tetrahedron takes, about: of a whole mesh, and of parts of it.
constexpr double bytes_whole = 2.2, bytes_of_parts = 3.6;

std::string deflated(const std::string& bytes, int strategy) {
  z_stream z{};
  if (deflateInit2(&z, 6, Z_DEFLATED, 15, 9, strategy) != Z_OK)
    throw std::bad_alloc();
  std::string out(deflateBound(&z, bytes.size()), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}
/// Numbers without repetition are smaller without a search for it.
std::string deflated(const std::string& bytes) {
  std::string a = deflated(bytes, Z_DEFAULT_STRATEGY), b = deflated(bytes, Z_HUFFMAN_ONLY);
  return a.size() <= b.size() ? a : b;
}

std::string base64(std::string_view bytes) {
  static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string s;
  s.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; ++k)
      v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k)
      s += i + k <= bytes.size() ? digit[v >> (18 - 6 * k) & 63] : '=';
  }
  return s;
}

/// Text for a script element: nothing in it ends it.
std::string in_script(std::string text) {
  for (size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return text;
}
std::string in_html(const std::string& text) {
  std::string s;
  for (const char c : text)
    s += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return s;
}
std::string quoted(const std::string& text) {
  std::string s = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      (s += '\\') += c;
    else if (static_cast<unsigned char>(c) < 32) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", c);
      s += code;
    } else
      s += c;
  return s + '"';
}
std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}

/// Tetrahedra of a mesh that is too large for the page: those with boundary triangles, those around the worst, and
/// those at `cuts` planes across each axis.
struct Parts {
  std::vector<uint8_t> keep;
  std::vector<double> cut[3]; ///< Å
  int64_t count = 0;
};
Parts parts_of(const TetMesh& m, const TriangleSides& sides, const std::vector<int64_t>& worst, int cuts) {
  Parts p;
  p.keep.assign(m.tet.size(), 0);
  for (const auto& side : sides.face)
    for (const int32_t f : side)
      if (f >= 0)
        p.keep[f / 4] = 1;
  std::vector<uint8_t> near(m.point.size());
  for (int ring = 0; ring < 2 && cuts > 0; ++ring) {
    if (ring == 0)
      for (const int64_t t : worst)
        for (const int32_t v : m.tet[t])
          near[v] = 1;
    std::vector<uint8_t> further = near;
    for (size_t t = 0; t < m.tet.size(); ++t)
      if (std::any_of(m.tet[t].begin(), m.tet[t].end(), [&](int32_t v) { return near[v]; })) {
        p.keep[t] = 1;
        for (const int32_t v : m.tet[t])
          further[v] = 1;
      }
    near.swap(further);
  }
  for (int axis = 0; axis < 3 && cuts > 0; ++axis) {
    double low = m.point[0][axis], high = low;
    for (const Vec3d& v : m.point)
      low = std::min(low, v[axis]), high = std::max(high, v[axis]);
    const double step = (high - low) / (cuts + 1);
    for (int k = 1; k <= cuts; ++k)
      p.cut[axis].push_back(low + k * step);
    for (size_t t = 0; t < m.tet.size(); ++t) {
      double least = 1e300, most = -1e300;
      for (const int32_t v : m.tet[t])
        least = std::min(least, m.point[v][axis]), most = std::max(most, m.point[v][axis]);
      // The first plane above the least; planes have the coordinates that the page is told.
      const auto at = std::upper_bound(p.cut[axis].begin(), p.cut[axis].end(), least - step * 1e-6);
      if (at != p.cut[axis].end() && *at < most + step * 1e-6)
        p.keep[t] = 1;
    }
  }
  p.count = std::count(p.keep.begin(), p.keep.end(), 1);
  return p;
}

struct Packed {
  std::string json, base64; ///< what the page must know of the code; the code
  LargeArray<int32_t> place;
};
Packed packed(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
              const std::vector<CellLabel>& labels, const Parts& parts, int threads) {
  MeshCode code = encode_mesh(m, sides, bodies, parts.keep, labels);
  std::vector<std::string> part(code.stream.size());
  par::for_n(static_cast<int64_t>(part.size()), threads, 1,
             [&](int64_t i) { part[i] = deflated(code.stream[i].bytes); });
  int64_t triangles = 0;
  for (const auto& side : sides.face)
    triangles += side[0] >= 0;
  Packed p;
  p.json = "\"code\":{\"tets\":" + std::to_string(code.tets) + ",\"points\":" + std::to_string(code.points) +
           ",\"triangles\":" + std::to_string(triangles) + ",\"quantum\":" + number(code.quantum) +
           ",\"origin\":[" + number(code.origin.x) + ',' + number(code.origin.y) + ',' + number(code.origin.z) +
           "],\"body_tets\":[";
  for (size_t b = 0; b < code.body_tets.size(); ++b)
    p.json += (b > 0 ? "," : "") + std::to_string(code.body_tets[b]);
  p.json += "],\"labels\":[";
  for (size_t l = 0; l < labels.size(); ++l)
    p.json += (l > 0 ? "," : "") + quoted(labels[l].name);
  p.json += "],\"streams\":[";
  std::string all;
  for (size_t s = 0; s < part.size(); ++s) {
    p.json += (s > 0 ? ",[" : "[") + quoted(code.stream[s].name) + ',' + std::to_string(part[s].size()) + ']';
    all += part[s];
  }
  p.json += "]}";
  p.base64 = base64(all);
  p.place = std::move(code.place);
  return p;
}

std::string palette_json() {
  using namespace picture;
  const auto bytes = [](Rgb c) {
    return std::to_string(c.r) + ',' + std::to_string(c.g) + ',' + std::to_string(c.b);
  };
  std::string s = "{\"ramp\":[";
  for (size_t i = 0; i < quality_ramp.size(); ++i)
    s += (i > 0 ? ",[" : "[") + number(quality_ramp[i].at) + ',' + bytes(quality_ramp[i].colour) + ']';
  s += "],\"labels\":[";
  for (size_t i = 0; i < label_list.size(); ++i)
    s += (i > 0 ? ",[" : "[") + bytes(label_list[i]) + ']';
  return s + "],\"none\":[" + bytes(no_label) + "],\"plain\":[" + bytes(plain) + "]}";
}

} // namespace

struct HtmlReport::Pages {
  struct Mesh {
    std::string json, base64, picture;
  };
  int64_t left, meshes;
  std::vector<Mesh> mesh;
  std::vector<std::string> left_out;
};

HtmlReport::HtmlReport(int64_t most_bytes, int64_t meshes)
    : pages_(new Pages{most_bytes - static_cast<int64_t>(embedded::three_js().size() / 2), meshes, {}, {}}) {}
HtmlReport::~HtmlReport() = default;
HtmlReport::HtmlReport(HtmlReport&&) noexcept = default;

bool HtmlReport::has_3d() {
  return !embedded::three_js().empty();
}

void HtmlReport::add(const TetMesh& m, const TriangleSides& sides, const MeshBodies& bodies,
                     const std::vector<CellLabel>& labels, const ReportedMesh& more, int threads) {
  const std::vector<int64_t> worst = worst_by_quality(m, worst_shown, threads);
  Pages::Mesh mesh;
  mesh.picture = base64(more.picture);
  const auto done = static_cast<int64_t>(pages_->mesh.size());
  const auto share = static_cast<double>(pages_->left / std::max<int64_t>(1, pages_->meshes - done)) -
                     static_cast<double>(mesh.picture.size());
  std::optional<Packed> code;
  Parts parts;
  const auto pack = [&](double guess) {
    if (guess > share)
      return;
    code = packed(m, sides, bodies, labels, parts, threads);
    if (static_cast<double>(code->base64.size()) > share)
      code.reset();
  };
  const auto tets = static_cast<double>(m.tet.size());
  if (has_3d())
    pack(0.8 * bytes_whole * tets);
  for (int cuts = 31; has_3d() && !code && cuts >= 0; cuts = cuts > 3 ? cuts / 2 : cuts - 3) {
    parts = parts_of(m, sides, worst, cuts);
    pack(0.7 * bytes_of_parts * static_cast<double>(parts.count));
  }
  mesh.json =
      facts_json(m, sides, bodies, labels, more, worst, code ? code->place : LargeArray<int32_t>(), threads) +
      ",\"index\":" + std::to_string(done);
  std::string out;
  if (code) {
    mesh.json += ',' + code->json;
    mesh.base64 = std::move(code->base64);
    if (!parts.keep.empty()) {
      const size_t cuts = parts.cut[0].size();
      out =
          "Of " + grouped(static_cast<int64_t>(m.tet.size())) + " tetrahedra the page holds " +
          grouped(parts.count) +
          (cuts > 0 ? ": all at the surface, all around the worst elements, and all that planes at " +
                          std::to_string(cuts) + " places along x, y and z cut; the cut moves from place to place."
                    : ": those at the surface; a cut shows no others.");
      if (cuts > 0) {
        mesh.json += ",\"cuts\":[";
        for (int axis = 0; axis < 3; ++axis) {
          mesh.json += axis > 0 ? ",[" : "[";
          for (size_t k = 0; k < cuts; ++k)
            mesh.json += (k > 0 ? "," : "") + number(parts.cut[axis][k]);
          mesh.json += ']';
        }
        mesh.json += ']';
      }
    }
  } else if (has_3d()) {
    out = "The page has a picture of this mesh alone: its " + grouped(static_cast<int64_t>(m.tet.size())) +
          " tetrahedra are too many for what the page may hold.";
    mesh.json += ",\"no_code\":\"the mesh is too large for this page\"";
  } else
    mesh.json += ",\"no_code\":\"this program was built without three.js\"";
  if (!out.empty()) {
    mesh.json += ",\"left_out\":" + quoted(out);
    pages_->left_out.push_back(more.name + ": " + out);
  }
  mesh.json += '}';
  pages_->left -= static_cast<int64_t>(mesh.json.size() + mesh.base64.size() + mesh.picture.size());
  pages_->mesh.push_back(std::move(mesh));
}

std::vector<std::string> HtmlReport::left_out() const {
  return pages_->left_out;
}

void HtmlReport::write(std::ostream& out, const std::string& title, const std::string& creator) const {
  const auto data = [&] {
    out << "<script type=\"application/json\" id=\"report\">{\"title\":" << in_script(quoted(title))
        << ",\"palette\":" << palette_json() << ",\"meshes\":[";
    bool any_3d = false;
    for (size_t i = 0; i < pages_->mesh.size(); ++i) {
      out << (i > 0 ? ",\n" : "\n") << in_script(pages_->mesh[i].json);
      any_3d |= !pages_->mesh[i].base64.empty();
    }
    out << "]}</script>\n";
    for (size_t i = 0; i < pages_->mesh.size(); ++i) {
      const Pages::Mesh& m = pages_->mesh[i];
      out << "<script type=\"text/plain\" id=\"picture-" << i << "\">" << m.picture << "</script>\n";
      if (!m.base64.empty())
        out << "<script type=\"text/plain\" id=\"mesh-" << i << "\">" << m.base64 << "</script>\n";
    }
    if (any_3d)
      out << "<script type=\"text/plain\" id=\"three\">"
          << base64(
                 deflated(std::string(embedded::three_js()) + "\n;" + std::string(embedded::orbit_controls_js())))
          << "</script>\n";
  };
  for (std::string_view rest = embedded::page_html(); !rest.empty();) {
    const size_t at = rest.find('@'), end = at == rest.npos ? at : rest.find('@', at + 1);
    if (end == rest.npos) {
      out << rest;
      break;
    }
    out << rest.substr(0, at);
    const std::string_view key = rest.substr(at + 1, end - at - 1);
    rest.remove_prefix(end + 1);
    if (key == "TITLE")
      out << in_html(title);
    else if (key == "CREATOR")
      out << in_html(creator);
    else if (key == "CSS")
      out << embedded::page_css();
    else if (key == "DATA")
      data();
    else if (key == "UNPACK")
      out << embedded::unpack_js();
    else if (key == "VIEW")
      out << embedded::view_js();
    else if (key == "PAGE")
      out << embedded::page_js();
  }
}

} // namespace molmesh::formats
