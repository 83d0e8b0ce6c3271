// xdmf.cpp — grids `mesh` (tetrahedra) and `facets` (triangles) over one HDF5 file.
#include "formats/xdmf/xdmf.hpp"
#include "formats/vtu/names.hpp"
#include "formats/xdmf/hdf5.hpp"
#include "formats/xml_text.hpp"
#include <ostream>

namespace molmesh::formats {
namespace {

/// A file's name in text.
std::string escaped_file(std::string name) {
  for (size_t i = name.find('&'); i != std::string::npos; i = name.find('&', i + 1))
    name.insert(i + 1, "amp;");
  return escaped(name);
}

class Writer {
public:
  Writer(std::ostream& out, const std::string& h5_name, const TetMesh& m)
      : out_(out), h5_name_(escaped_file(h5_name)), m_(m) {}

  void write(std::ostream& h5) {
    const size_t points = m_.point.size(), tets = m_.tet.size(), tris = m_.tri.size();
    const std::string geometry = file_.add("mesh", "geometry", points, 3, &m_.point[0].x);
    out_ << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n";
    begin_grid("mesh", "Tetrahedron", file_.add("mesh", "topology", tets, 4, m_.tet[0].data()), tets, 4, geometry);
    attribute("region", file_.add("mesh", "region", tets, 1, m_.region.data()), tets, false);
    if (!m_.part.empty())
      attribute("part", file_.add("mesh", "part", tets, 1, m_.part.data()), tets, false);
    arrays("mesh", 0, tets);
    out_ << "</Grid>\n";
    if (tris > 0) {
      const ExportLabels labels = export_labels(m_);
      begin_grid("facets", "Triangle", file_.add("facets", "topology", tris, 3, m_.tri[0].data()), tris, 3,
                 geometry);
      attribute("patch", file_.add("facets", "patch", tris, 1, labels.patch.data()), tris, false);
      arrays("facets", tets, tris);
      out_ << "</Grid>\n";
      std::string names;
      for (const auto& [label, name] : labels.patch_name)
        names += std::to_string(label) + ' ' + name + '\n';
      file_.add("names", "patch", names);
    }
    for (const NamedText& t : m_.named_text)
      if (t.name != "patch_names")
        file_.add("names", t.name, t.text);
    out_ << "</Domain>\n</Xdmf>\n";
    file_.write(h5);
  }

private:
  void begin_grid(const char* name, const char* cell, const std::string& topology, size_t cells, int corners,
                  const std::string& geometry) {
    out_ << "<Grid Name=\"" << name << "\" GridType=\"Uniform\">\n<Topology TopologyType=\"" << cell
         << "\" NumberOfElements=\"" << cells << "\" NodesPerElement=\"" << corners << "\">\n";
    data(std::to_string(cells) + " " + std::to_string(corners), false, topology);
    out_ << "</Topology>\n<Geometry GeometryType=\"XYZ\">\n";
    data(std::to_string(m_.point.size()) + " 3", true, geometry);
    out_ << "</Geometry>\n";
  }
  void data(const std::string& extents, bool real, const std::string& path) {
    out_ << "<DataItem Dimensions=\"" << extents << "\" NumberType=\"" << (real ? "Float" : "Int")
         << "\" Precision=\"" << (real ? 8 : 4) << "\" Format=\"HDF\">" << h5_name_ << ':' << path
         << "</DataItem>\n";
  }
  void attribute(const std::string& name, const std::string& path, size_t cells, bool real) {
    out_ << "<Attribute Name=\"" << escaped(name) << "\" AttributeType=\"Scalar\" Center=\"Cell\">\n";
    data(std::to_string(cells) + " 1", real, path); // two extents, as DOLFINx writes them
    out_ << "</Attribute>\n";
  }
  /// Cells [begin, begin + cells) of the further arrays.
  void arrays(const char* group, size_t begin, size_t cells) {
    for (const CellArray& a : m_.cell_array)
      if (a.name != "patch")
        attribute(a.name,
                  a.real.empty() ? file_.add(group, a.name, cells, 1, a.integer.data() + begin)
                                 : file_.add(group, a.name, cells, 1, a.real.data() + begin),
                  cells, !a.real.empty());
  }

  std::ostream& out_;
  const std::string h5_name_; // escaped
  const TetMesh& m_;
  Hdf5File file_;
};

} // namespace

void write_xdmf(std::ostream& xdmf, std::ostream& h5, const std::string& h5_name, const TetMesh& m) {
  Writer(xdmf, h5_name, m).write(h5);
}

} // namespace molmesh::formats
