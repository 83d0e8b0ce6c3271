// nastran.cpp — fields of 8 characters, of 16 for coordinates; properties are regions and boundaries.
#include "formats/nastran/nastran.hpp"
#include "base/error.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include <algorithm>
#include <array>
#include <charconv>

namespace molmesh::formats {
namespace {

constexpr int64_t largest = 99999999; // of a field

/// Left-justified in a field.
void field(TextOut& out, std::string_view text, size_t width) {
  static constexpr std::string_view blanks = "                ";
  out << text << blanks.substr(0, width - text.size());
}
void field(TextOut& out, int64_t v) {
  field(out, std::to_string(v), 8);
}

/// At most 16 characters with a point, as exact as these allow.
void coordinate(TextOut& out, double v) {
  std::array<char, 40> text{};
  for (int digits = 17; digits > 0; --digits) {
    const auto end =
        digits == 17
            ? std::to_chars(text.data(), text.data() + text.size(), v).ptr
            : std::to_chars(text.data(), text.data() + text.size(), v, std::chars_format::general, digits).ptr;
    std::string s(text.data(), end);
    if (s.find('.') == std::string::npos) // Nastran takes it for an integer
      s.insert(std::min(s.find('e'), s.size()), ".");
    if (s.size() <= 16)
      return field(out, s, 16);
  }
}

} // namespace

void write_nastran(std::ostream& stream, const TetMesh& m, const std::string& file) {
  const ExportLabels labels = export_labels(m);
  const auto most = [](const auto& names) { return names.empty() ? 0 : int64_t{names.rbegin()->first}; };
  if (std::max({int64_t{std::ssize(m.point)}, int64_t{std::ssize(m.tet) + std::ssize(m.tri)},
                most(labels.region_name), most(labels.patch_name)}) > largest)
    fail_input(file +
               ": a number of a point, an element or a label over 99999999, expected at most 8 digits for Nastran");
  TextOut out(stream);
  out << "$ tetrahedral mesh by molmesh\n";
  for (const auto& [region, name] : labels.region_name)
    out << "$ PSOLID " << region << ": " << name << '\n';
  for (const auto& [label, name] : labels.patch_name)
    out << "$ PSHELL " << label << ": " << name << '\n';
  out << "BEGIN BULK\n";
  for (size_t p = 0; p < m.point.size(); ++p) {
    field(out, "GRID*", 8);
    field(out, std::to_string(p + 1), 16);
    field(out, "", 16); // the basic coordinates
    coordinate(out, m.point[p].x);
    coordinate(out, m.point[p].y);
    out << "\n";
    field(out, "*", 8);
    coordinate(out, m.point[p].z);
    out << '\n';
  }
  const auto cell = [&](const char* card, int64_t number, int32_t property, const auto& corners) {
    field(out, card, 8);
    field(out, number);
    field(out, property);
    for (const int32_t p : corners)
      field(out, p + int64_t{1});
    out << '\n';
  };
  for (size_t t = 0; t < m.tet.size(); ++t)
    cell("CTETRA", static_cast<int64_t>(t) + 1, m.region[t], m.tet[t]);
  for (size_t t = 0; t < m.tri.size(); ++t)
    cell("CTRIA3", static_cast<int64_t>(m.tet.size() + t) + 1, labels.patch[t], m.tri[t]);
  for (const auto& [region, name] : labels.region_name) {
    field(out, "PSOLID", 8);
    field(out, region);
    field(out, 1);
    out << '\n';
  }
  for (const auto& [label, name] : labels.patch_name) {
    field(out, "PSHELL", 8);
    field(out, label);
    field(out, 1);
    out << "1.\n";
  }
  out << "MAT1    1       1.              0.3\nENDDATA" << '\n';
}

} // namespace molmesh::formats
