// hier_writer.cpp — .hier, record by record, through a buffer.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/hier/text.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>

namespace molmesh::formats {
namespace {

constexpr size_t buffer_size = size_t{1} << 16;

bool is_plain(char c) {
  return c > ' ' && c < 0x7F && c != '%';
}

} // namespace

HierWriter::HierWriter(std::ostream& out, std::string_view source, const std::vector<std::string>& levels,
                       Version version)
    : out_(out), levels_(levels) {
  for (const std::string& level : levels)
    if (!is_level_name(level, version == Version::v1 ? 1 : 2))
      fail_input("level '" + level + "', expected a word that .hier does not reserve");
  buffer_.reserve(buffer_size + 4096);
  buffer_ = version == Version::v1 ? "hier 1\n" : "hier 2\n";
  if (!source.empty()) {
    buffer_ += "source ";
    buffer_ += source;
    buffer_ += '\n';
  }
  put("levels");
  for (const std::string& level : levels) {
    buffer_ += ' ';
    put(level);
  }
  end_record();
}

void HierWriter::group(size_t level, std::string_view name, double exponent, double weight) {
  put(levels_[level]);
  put_name(name);
  put_number(exponent);
  if (weight != 1)
    put_number(weight);
  end_record();
}

void HierWriter::atom(std::string_view name, std::string_view element, Vec3d center, double radius, double charge) {
  put("atom");
  put_name(name);
  put_name(element);
  for (const double v : {center.x, center.y, center.z, radius})
    put_number(v);
  if (!std::isnan(charge))
    put_number(charge);
  end_record();
}

void HierWriter::body(std::string_view name, const Body& b) {
  using Shape = Body::Shape;
  put("body");
  put_name(name);
  put_name(shape_name(b.shape));
  const auto put_vector = [&](Vec3d v) {
    for (const double x : {v.x, v.y, v.z})
      put_number(x);
  };
  put_vector(b.center);
  if (b.shape != Shape::sphere)
    put_vector(b.u);
  if (b.shape == Shape::box)
    put_vector(b.v);
  put_number(b.size);
  put_number(b.skin);
  end_record();
}

void HierWriter::finish() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

void HierWriter::put(std::string_view word) {
  buffer_ += word;
}

void HierWriter::put_name(std::string_view name) {
  buffer_ += ' ';
  if (std::all_of(name.begin(), name.end(), is_plain))
    buffer_ += name;
  else
    percent_encode(buffer_, name);
}

void HierWriter::put_number(double value) {
  buffer_ += ' ';
  char text[40];
  char* end = text + sizeof text;
  // Coordinates mostly have three decimals: n / 1000 with n an integer below 10¹², and then "n/1000" reads back
  // exactly.
  const double size = std::abs(value);
  auto n = size < 1e9 ? static_cast<int64_t>(size * 1000 + 0.5) : 0;
  if (n != 0 && static_cast<double>(n) / 1000 == size) {
    char* p = end;
    int decimals = static_cast<int>(n % 1000);
    n /= 1000;
    if (decimals != 0) {
      int width = 3;
      for (; decimals % 10 == 0; decimals /= 10)
        --width;
      for (; width > 0; --width, decimals /= 10)
        *--p = static_cast<char>('0' + decimals % 10);
      *--p = '.';
    }
    do {
      *--p = static_cast<char>('0' + n % 10);
      n /= 10;
    } while (n != 0);
    if (value < 0)
      *--p = '-';
    buffer_.append(p, end);
  } else {
    buffer_.append(text, std::to_chars(text, end, value).ptr);
  }
}

void HierWriter::end_record() {
  buffer_ += '\n';
  if (buffer_.size() >= buffer_size)
    finish();
}

void write_hier(std::ostream& out, const Hierarchy& h) {
  check(h, "hierarchy");
  std::vector<std::string> levels;
  for (const Level& level : h.level)
    levels.push_back(level.name);
  const bool weights = std::any_of(h.level.begin(), h.level.end(), [](const Level& level) {
    return std::any_of(level.group.begin(), level.group.end(), [](const Group& g) { return g.weight != 1; });
  });
  const bool charges_alone =
      std::any_of(h.atom.begin(), h.atom.end(), [](const Atom& atom) { return atom.radius == 0; });
  const bool needs_version_2 = !h.body.empty() || charges_alone || weights;
  HierWriter writer(out, h.source, levels, needs_version_2 ? HierWriter::Version::v2 : HierWriter::Version::v1);
  auto body = h.body.begin();
  // next[l]: the group of level l that opens at its first child.
  std::vector<size_t> next(h.level.size(), 0);
  const auto open = [&](auto&& self, size_t l, int64_t child) -> void {
    if (l == 0)
      return;
    const std::vector<Group>& groups = h.level[l - 1].group;
    size_t& n = next[l - 1];
    if (n == groups.size() || groups[n].begin != child)
      return;
    self(self, l - 1, static_cast<int64_t>(n));
    writer.group(l - 1, groups[n].name, groups[n].exponent, groups[n].weight);
    ++n;
  };
  for (size_t a = 0; a < h.atom.size(); ++a) {
    open(open, h.level.size(), static_cast<int64_t>(a));
    const Atom& atom = h.atom[a];
    if (body != h.body.end() && body->atom == static_cast<int64_t>(a)) {
      writer.body(h.names[atom.name], *body++);
      continue;
    }
    writer.atom(h.names[atom.name], h.names[atom.element], atom.center, atom.radius, atom.charge);
  }
  writer.finish();
}

} // namespace molmesh::formats
