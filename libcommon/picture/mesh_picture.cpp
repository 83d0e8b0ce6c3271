// mesh_picture.cpp — chooses what is seen, looks at it from the viewer's place, and captions it.
#include "picture/mesh_picture.hpp"
#include "base/grouped.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include "picture/colours.hpp"
#include "picture/drawing.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace molmesh::picture {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

struct Camera {
  Vec3d right, up, towards;
  double scale = 1, x0 = 0, y0 = 0; ///< pixels an Å; where the origin is

  explicit Camera(const View& v) {
    const double a = v.azimuth * degree, e = v.elevation * degree;
    towards = {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    right = {-std::sin(a), std::cos(a), 0};
    up = cross(towards, right);
  }
  Vec3f operator()(Vec3d p) const {
    return {static_cast<float>(x0 + scale * dot(right, p)), static_cast<float>(y0 - scale * dot(up, p)),
            static_cast<float>(scale * dot(towards, p))};
  }
  Vec3f turned(Vec3d n) const {
    return {static_cast<float>(dot(right, n)), static_cast<float>(-dot(up, n)),
            static_cast<float>(dot(towards, n))};
  }
};

/// Cells of the mesh and the cut.
class Visible {
public:
  Visible(const TetMesh& m, const PictureOptions& o, int threads)
      : beyond_(m.point.size()), all_((1 << o.cut.plane.size()) - 1) {
    par::for_n(static_cast<int64_t>(m.point.size()), threads, [&](int64_t i) {
      for (size_t k = 0; k < o.cut.plane.size(); ++k)
        if (dot(o.cut.plane[k].normal, m.point[i]) > o.cut.plane[k].offset)
          beyond_[i] = static_cast<uint8_t>(beyond_[i] | 1 << k);
    });
  }
  enum Place { kept, at_cut, removed };
  template <class Cell>
  Place place(const Cell& c) const {
    uint8_t every = all_, some = 0;
    for (const int32_t v : c)
      every = static_cast<uint8_t>(every & beyond_[v]), some = static_cast<uint8_t>(some | beyond_[v]);
    return all_ == 0 || some != all_ ? kept : every == all_ ? removed : at_cut;
  }

private:
  std::vector<uint8_t> beyond_; ///< [points] a bit a plane
  uint8_t all_;
};

bool shown(const PictureOptions& o, int32_t region) {
  return std::find(o.region.begin(), o.region.end(), region) != o.region.end();
}

bool on_box(int32_t boundary) {
  return boundary >= Boundary::box_x0 && boundary <= Boundary::box_z1;
}

struct Drawn {
  Scene scene;
  bool cut = false;
  double edge = 0; ///< Å, about that of the triangles
};

/// Facets on the mesh's own points.
Drawn facets(const TetMesh& m, const Colouring& colouring, const PictureOptions& o, std::array<double, 2> range,
             int threads) {
  const Visible visible(m, o, threads);
  Drawn d;
  // Regions beside a triangle are not stored: a triangle is shown where a point's tetrahedra are.
  std::vector<uint8_t> seen(m.point.size());
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (shown(o, m.region[t]))
      for (const int32_t v : m.tet[t])
        seen[v] = 1;
  double edges = 0;
  int64_t count = 0;
  for (size_t i = 0; i < m.tri.size(); ++i) {
    const Tri& t = m.tri[i];
    if (!seen[t[0]] || !seen[t[1]] || !seen[t[2]] || visible.place(t) == Visible::removed)
      continue;
    d.scene.facet.push_back(
        {t, colouring.triangle.empty() ? plain : colouring.triangle[i], !on_box(m.boundary[i])});
    edges += norm(m.point[t[1]] - m.point[t[0]]);
    ++count;
  }
  if (!o.cut.plane.empty())
    for (size_t i = 0; i < m.tet.size(); ++i) {
      const Tet& t = m.tet[i];
      if (visible.place(t) != Visible::at_cut || !shown(o, m.region[i]))
        continue;
      d.cut = true;
      const double share = range[1] > range[0]
                               ? (smallest_dihedral(m, static_cast<int64_t>(i)) - range[0]) / (range[1] - range[0])
                               : 1;
      const auto of_region = colouring.region.find(m.region[i]);
      const Rgb colour = of_region != colouring.region.end() ? of_region->second : ramp_colour(share);
      for (int f = 0; f < 4; ++f)
        d.scene.facet.push_back({{t[tet_face(f, 0)], t[tet_face(f, 1)], t[tet_face(f, 2)]}, colour, false});
    }
  d.edge = count > 0 ? edges / static_cast<double>(count) : 0;
  return d;
}

/// Normals of the smooth facets' points, by area.
void add_normals(const TetMesh& m, Scene& s, const Camera& camera) {
  std::vector<Vec3d> sum(m.point.size());
  for (size_t i = 0; i < m.tri.size(); ++i)
    if (!on_box(m.boundary[i])) {
      const Tri& t = m.tri[i];
      const Vec3d n = tri_normal(m.point[t[0]], m.point[t[1]], m.point[t[2]]);
      for (const int32_t v : t)
        sum[v] += n;
    }
  s.normal.resize(sum.size());
  for (size_t i = 0; i < sum.size(); ++i) {
    const double length = norm(sum[i]);
    s.normal[i] = length > 0 ? camera.turned(sum[i] / length) : Vec3f{};
  }
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, std::fabs(v - std::round(v)) < 1e-9 ? "%.0f" : "%.1f", v);
  return text;
}

class Caption {
public:
  Caption(Image& image, double size) : image_(image), size_(size), gap_(1.2 * size) {}

  void title(const TetMesh& m, const std::string& name) {
    const std::string text = shortened(name, 1.15 * size_, image_.width - 2 * gap_);
    halo(gap_, gap_ + size_, text, 1.15 * size_);
    halo(gap_, gap_ + 2.5 * size_,
         grouped(static_cast<int64_t>(m.tet.size())) + " tetrahedra, " +
             grouped(static_cast<int64_t>(m.tri.size())) + " triangles",
         0.95 * size_);
  }

  /// The ramp with the range of its values; ticks at round numbers between.
  void bar(std::array<double, 2> range) {
    const double width = std::min(22 * size_, image_.width - 2 * gap_), height = 0.9 * size_,
                 y = image_.height - gap_ - 1.6 * size_ - height;
    halo(gap_, y - 0.6 * size_, "smallest dihedral angle of a tetrahedron at the cut", 0.95 * size_);
    for (int i = 0; i < static_cast<int>(width); ++i)
      fill_rectangle(image_, gap_ + i, y, std::min(2., width - i), height, ramp_colour((i + 0.5) / width));
    const double span = range[1] - range[0];
    const auto tick = [&](double v, double near) {
      const double x = gap_ + (span > 0 ? (v - range[0]) / span : 0) * width;
      const std::string text = number(v) + "°";
      const double w = text_width(text, 0.9 * size_);
      fill_rectangle(image_, x - 0.6, y + height, 1.2, 0.3 * size_, ink);
      halo(std::clamp(x - near * w, gap_, gap_ + width - w), y + height + 1.3 * size_, text, 0.9 * size_);
    };
    tick(range[0], 0);
    if (!(span > 0))
      return;
    tick(range[1], 1);
    const double step = span > 80   ? 30
                        : span > 30 ? 10
                        : span > 12 ? 5
                        : span > 5  ? 2
                                    : 1,
                 clear = 3.4 * size_ / width * span;
    for (double v = std::ceil(range[0] / step) * step; v < range[1]; v += step)
      if (v - range[0] > clear && range[1] - v > clear)
        tick(v, 0.5);
  }

  void legend(const Colouring& c) {
    constexpr size_t most = 14;
    if (c.legend.empty())
      return;
    double x = image_.width - gap_, y = gap_;
    double width = text_width(c.title, 0.95 * size_);
    for (size_t i = 0; i < c.legend.size() && i < most; ++i)
      width = std::max(width, 1.5 * size_ + text_width(c.legend[i].first, 0.95 * size_));
    width = std::min(width, 0.3 * image_.width);
    x -= width;
    halo(x, y + size_, c.title, 0.95 * size_);
    for (size_t i = 0; i < c.legend.size(); ++i) {
      y += 1.5 * size_;
      if (i + 1 == most && c.legend.size() > most) {
        halo(x, y + size_, "and " + grouped(static_cast<int64_t>(c.legend.size() - i)) + " more", 0.95 * size_);
        break;
      }
      fill_rectangle(image_, x, y + 0.1 * size_, size_, size_, c.legend[i].second);
      halo(x + 1.5 * size_, y + size_, shortened(c.legend[i].first, 0.95 * size_, width - 1.5 * size_),
           0.95 * size_);
    }
  }

  /// A bar of a round length; scale: pixels an Å.
  void lengths(double scale) {
    const double most = 0.2 * image_.width / scale;
    double length = std::pow(10, std::floor(std::log10(most)));
    length *= most >= 5 * length ? 5 : most >= 2 * length ? 2 : 1;
    const double width = length * scale, x = image_.width - gap_ - width, y = image_.height - gap_;
    const std::string text = length < 10000 ? number(length) + " Å" : grouped(static_cast<int64_t>(length)) + " Å";
    fill_rectangle(image_, x - 2, y - 5, width + 4, 7, white, 0.7);
    fill_rectangle(image_, x, y - 3, width, 3, ink);
    halo(x + (width - text_width(text, 0.95 * size_)) / 2, y - 0.7 * size_, text, 0.95 * size_);
  }

private:
  /// On a light ground, so that it is read in front of the mesh, too.
  void halo(double x, double y, const std::string& text, double size) {
    fill_rectangle(image_, x - 3, y - 0.95 * size, text_width(text, size) + 6, 1.25 * size, white, 0.7);
    draw_text(image_, x, y, text, size, ink);
  }
  Image& image_;
  double size_, gap_;
};

} // namespace

double smallest_dihedral(const TetMesh& m, int64_t tet) {
  const auto p = [&](size_t i) { return m.point[m.tet[tet][i]]; };
  const DihedralTrig d = dihedral_trig(p(0), p(1), p(2), p(3));
  int least = 0; // the largest cosine, of an inverted element the smallest: one arc tangent
  for (int e = 0; e < 6; ++e) {
    if (!(d.cosine[e] == d.cosine[e]))
      return 0; // flat
    if (d.sine[e] < 0 ? d.cosine[e] < d.cosine[least] : d.cosine[e] > d.cosine[least])
      least = e;
  }
  return std::atan2(d.sine[least] + 0.0, d.cosine[least]) / degree;
}

std::array<double, 2> smallest_dihedrals(const TetMesh& m, const std::vector<int32_t>& region, int threads) {
  using Range = std::array<double, 2>;
  const Range r = par::reduce(
      static_cast<int64_t>(m.tet.size()), threads, Range{1e30, -1e30},
      [&](int64_t t) {
        if (std::find(region.begin(), region.end(), m.region[t]) == region.end())
          return Range{1e30, -1e30};
        const double v = smallest_dihedral(m, t);
        return Range{v, v};
      },
      [](Range a, Range b) {
        return Range{std::min(a[0], b[0]), std::max(a[1], b[1])};
      });
  return r[0] <= r[1] ? r : Range{0, 0};
}

Cut cut_facing(const View& view, const std::string& axes, double share, Vec3d low, Vec3d high) {
  const Vec3d towards = Camera(view).towards;
  Cut cut;
  for (const char a : axes) {
    const int axis = a - 'x';
    const double side = towards[axis] < 0 ? -1 : 1, at = side > 0 ? 1 - share : share;
    Vec3d normal;
    normal[axis] = side;
    cut.plane.push_back({normal, side * (low[axis] + at * (high[axis] - low[axis]))});
  }
  return cut;
}

BestView best_view(const TetMesh& m, const std::vector<uint8_t>& marked, int threads) {
  Scene scene;
  scene.point.resize(m.point.size());
  RasterOptions small;
  small.width = small.height = 240;
  small.samples = 1;
  small.shade_hollows = false;
  Vec3d sum, low{1e300, 1e300, 1e300}, high = -1. * low;
  for (size_t i = 0; i < m.tri.size(); ++i) {
    if (on_box(m.boundary[i]))
      continue;
    const Tri& t = m.tri[i];
    scene.facet.push_back({t, marked[i] ? Rgb{0, 0, 0} : white, false});
    if (marked[i])
      sum += tri_normal(m.point[t[0]], m.point[t[1]], m.point[t[2]]);
    for (const int32_t v : t)
      for (int k = 0; k < 3; ++k)
        low[k] = std::min(low[k], m.point[v][k]), high[k] = std::max(high[k], m.point[v][k]);
  }
  std::vector<View> views{{std::round(std::atan2(sum.y, sum.x) / degree),
                           std::round(std::atan2(sum.z, std::hypot(sum.x, sum.y)) / degree)},
                          {0, 90},
                          {0, -90}};
  for (const double elevation : {0., 45., -45.})
    for (double azimuth = -180; azimuth < 180; azimuth += 45)
      views.push_back({azimuth, elevation});
  BestView best{views[0], 0};
  for (const View& v : views) {
    Camera camera(v);
    const Vec3d middle = 0.5 * (low + high);
    camera.scale = small.width / std::max(norm(high - low), 1e-9);
    camera.x0 = small.width / 2. - camera.scale * dot(camera.right, middle);
    camera.y0 = small.height / 2. + camera.scale * dot(camera.up, middle);
    par::for_n(static_cast<int64_t>(m.point.size()), threads,
               [&](int64_t i) { scene.point[i] = camera(m.point[i]); });
    const Image image = draw_scene(scene, small, threads);
    int64_t pixels = 0; // black ones: light leaves them so, and white ones far from it
    for (size_t i = 0; i < image.rgb.size(); i += 3)
      pixels += image.rgb[i] < 30;
    if (pixels > best.pixels)
      best = {v, pixels};
  }
  return best;
}

Image draw_mesh(const TetMesh& m, const Colouring& colouring, const PictureOptions& o, int threads) {
  const std::array<double, 2> range = smallest_dihedrals(m, o.region, threads);
  Drawn drawn = facets(m, colouring, o, range, threads);
  Camera camera(o.view);
  // The view is that of the whole, so that cuts of one mesh can be compared.
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (shown(o, m.region[t]))
      for (const int32_t v : m.tet[t]) {
        const double at[2] = {dot(camera.right, m.point[v]), -dot(camera.up, m.point[v])};
        for (int k = 0; k < 2; ++k)
          low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
      }
  const double size = std::clamp(o.raster.height / 52., 9., 60.);
  // As below: something is left for the mesh.
  const bool caption_fits = o.caption && o.raster.height > 9.4 * size && o.raster.width > 3 * size;
  const double border = caption_fits ? 1.5 * size : std::min(0.03 * o.raster.width, 0.1 * o.raster.height),
               foot = caption_fits ? 5.2 * size : border, head = caption_fits ? 4.2 * size : border;
  if (low[0] <= high[0]) {
    const double width = std::max(high[0] - low[0], 1e-9), height = std::max(high[1] - low[1], 1e-9);
    camera.scale = std::min((o.raster.width - 2 * border) / width, (o.raster.height - head - foot) / height);
    camera.x0 = o.raster.width / 2. - camera.scale * (low[0] + high[0]) / 2;
    camera.y0 = head + (o.raster.height - head - foot) / 2 - camera.scale * (low[1] + high[1]) / 2;
  }
  drawn.scene.point.resize(m.point.size());
  par::for_n(static_cast<int64_t>(m.point.size()), threads,
             [&](int64_t i) { drawn.scene.point[i] = camera(m.point[i]); });
  add_normals(m, drawn.scene, camera);
  if (o.edges) {
    const double pixels = drawn.edge * camera.scale; // drawn all, edges of a few pixels would hide the colours
    drawn.scene.edge_width = std::clamp(pixels / 14, 0.5, 1.4);
    drawn.scene.edge_opacity = std::clamp((pixels - 2) / 10, 0., 0.6);
  }
  Image image = draw_scene(drawn.scene, o.raster, threads);
  if (caption_fits) {
    Caption caption(image, size);
    caption.title(m, o.title);
    caption.legend(colouring);
    if (drawn.cut && colouring.region.empty())
      caption.bar(range);
    caption.lengths(camera.scale);
  }
  return image;
}

} // namespace molmesh::picture
