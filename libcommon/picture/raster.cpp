// raster.cpp — each band of rows is filled by one thread, from the facets that reach into it.
#include "picture/raster.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::picture {
namespace {

constexpr float far_away = -3e38f;
constexpr int band_rows = 32; // of samples

struct Samples {
  int width, height;
  LargeArray<float> depth;
  LargeArray<Rgb> colour;
};

float brightness(Vec3f n) {
  const float length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  if (!(length > 0))
    return 0.6f;
  const float s = (n.z < 0 ? -1.f : 1.f) / length; // towards the viewer
  const Vec3f u{s * n.x, s * n.y, s * n.z};
  // A lamp at the upper left, one at the viewer; y is down.
  const float key = std::max(0.f, -0.45f * u.x - 0.55f * u.y + 0.70f * u.z), face = u.z;
  const float shine = std::pow(std::max(0.f, -0.24f * u.x - 0.30f * u.y + 0.92f * u.z), 40.f);
  return 0.44f + 0.44f * key + 0.22f * face + 0.10f * shine;
}

Rgb lit(Rgb c, float light) {
  const auto part = [&](uint8_t v) { return static_cast<uint8_t>(std::min(255.f, v * light + 0.5f)); };
  return {part(c.r), part(c.g), part(c.b)};
}

class Band {
public:
  Band(const Scene& scene, Samples& out, int samples, int first, int last)
      : scene_(scene), out_(out), samples_(samples), first_(first), last_(last),
        half_edge_(static_cast<float>(scene.edge_width * samples / 2)) {}

  void draw(const Scene::Facet& f) {
    Vec3f p[3];
    for (size_t i = 0; i < 3; ++i) {
      const Vec3f q = scene_.point[f.corner[i]];
      const auto s = static_cast<float>(samples_);
      p[i] = {s * q.x, s * q.y, s * q.z};
    }
    const double ax = double(p[1].x) - p[0].x, ay = double(p[1].y) - p[0].y, bx = double(p[2].x) - p[0].x,
                 by = double(p[2].y) - p[0].y, area2 = ax * by - ay * bx;
    if (area2 == 0)
      return;
    const int x0 = pixel(std::min({p[0].x, p[1].x, p[2].x}), 0, out_.width),
              x1 = pixel(std::max({p[0].x, p[1].x, p[2].x}), -1, out_.width - 1),
              y0 = std::max(first_, pixel(std::min({p[0].y, p[1].y, p[2].y}), 0, out_.height)),
              y1 = std::min(last_, pixel(std::max({p[0].y, p[1].y, p[2].y}), -1, out_.height - 1));
    if (x0 > x1 || y0 > y1)
      return;
    const Vec3f own = cross(p[1] - p[0], p[2] - p[0]);
    const float flat = brightness(own);
    const bool smooth = f.smooth && !scene_.normal.empty();
    // Share w[i] of corner i, and the distance from the opposite edge, in samples, a share stands for.
    const double inverse = 1 / area2;
    float height[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3f a = p[(i + 1) % 3], b = p[(i + 2) % 3];
      height[i] = static_cast<float>(std::fabs(area2) / std::hypot(double(b.x) - a.x, double(b.y) - a.y));
    }
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double dx = x + 0.5 - p[0].x, dy = y + 0.5 - p[0].y, w1 = (dx * by - dy * bx) * inverse,
                     w2 = (ax * dy - ay * dx) * inverse, w0 = 1 - w1 - w2;
        if (w0 < 0 || w1 < 0 || w2 < 0)
          continue;
        const auto z = static_cast<float>(w0 * p[0].z + w1 * p[1].z + w2 * p[2].z);
        const size_t at = static_cast<size_t>(y) * static_cast<size_t>(out_.width) + static_cast<size_t>(x);
        if (!(z > out_.depth[at]))
          continue;
        out_.depth[at] = z;
        float light = flat;
        if (smooth) {
          const Vec3f a = scene_.normal[f.corner[0]], b = scene_.normal[f.corner[1]],
                      c = scene_.normal[f.corner[2]];
          const Vec3f n = static_cast<float>(w0) * a + static_cast<float>(w1) * b + static_cast<float>(w2) * c;
          if (norm2(n) > 0)
            light = brightness(n);
        }
        Rgb c = lit(f.colour, light);
        if (half_edge_ > 0 && std::min({static_cast<float>(w0) * height[0], static_cast<float>(w1) * height[1],
                                        static_cast<float>(w2) * height[2]}) < half_edge_)
          c = mixed(c, {20, 24, 30}, scene_.edge_opacity);
        out_.colour[at] = c;
      }
  }

private:
  /// The sample at or beside a coordinate, within limits.
  static int pixel(float v, int shift, int most) {
    const float low = -1, high = static_cast<float>(most + 1);
    return std::clamp(static_cast<int>(std::floor(std::clamp(v, low, high) + 0.5f)) + shift, 0, most);
  }

  const Scene& scene_;
  Samples& out_;
  int samples_, first_, last_;
  float half_edge_;
};

/// The facets that reach into each band, ascending.
struct Bins {
  std::vector<int64_t> start;
  LargeArray<int32_t> facet;
};

Bins bins_of(const Scene& s, int samples, int height, int bands) {
  const auto band = [&](float y) {
    return std::clamp(
        static_cast<int>(
            std::floor(std::clamp(y * static_cast<float>(samples), -1.f, static_cast<float>(height)) / band_rows)),
        0, bands - 1);
  };
  const auto each = [&](auto&& f) {
    for (size_t i = 0; i < s.facet.size(); ++i) {
      const auto& c = s.facet[i].corner;
      const float a = s.point[c[0]].y, b = s.point[c[1]].y, d = s.point[c[2]].y;
      for (int k = band(std::min({a, b, d}) - 1), last = band(std::max({a, b, d}) + 1); k <= last; ++k)
        f(k, static_cast<int32_t>(i));
    }
  };
  Bins bins;
  bins.start.assign(static_cast<size_t>(bands) + 1, 0);
  each([&](int k, int32_t) { ++bins.start[static_cast<size_t>(k)]; });
  bins.facet.resize(static_cast<size_t>(par::exclusive_scan(bins.start)));
  std::vector<int64_t> to = bins.start;
  each([&](int k, int32_t i) { bins.facet[to[static_cast<size_t>(k)]++] = i; });
  return bins;
}

/// Places on rings around a pixel, the inner rings first.
struct Surroundings {
  struct Place {
    int i, j; ///< from the pixel's middle, samples
    float r;  ///< of its ring
  };
  std::vector<Place> place;

  explicit Surroundings(int samples) {
    constexpr int directions = 12;
    constexpr float radius[] = {2.5f, 6, 13, 26}; // pixels
    for (size_t ring = 0; ring < 4; ++ring)
      for (int k = 0; k < directions; ++k) {
        const double angle = (k + 0.25 * static_cast<double>(ring)) * 6.283185307179586 / directions;
        const float r = radius[ring] * static_cast<float>(samples);
        place.push_back({static_cast<int>(std::lround(r * std::cos(angle))),
                         static_cast<int>(std::lround(r * std::sin(angle))), r});
      }
  }
};

/// How much of the sky over a pixel its surroundings hide, 0 to 1: depths on rings around it.
float hidden(const Samples& s, int samples, const Surroundings& around, int x, int y) {
  const int cx = x * samples + samples / 2, cy = y * samples + samples / 2;
  const auto depth = [&](int i, int j) {
    return s.depth[static_cast<size_t>(j) * static_cast<size_t>(s.width) + static_cast<size_t>(i)];
  };
  const float own = depth(cx, cy);
  if (own == far_away)
    return 0;
  float sum = 0;
  for (const auto& [di, dj, r] : around.place) {
    const int i = cx + di, j = cy + dj;
    if (i < 0 || j < 0 || i >= s.width || j >= s.height)
      continue;
    const float d = depth(i, j);
    const float rise = (d == far_away ? 0 : d - own) / r - 0.15f;
    if (rise > 0) // what is far in front hides less than what is close by
      sum += std::min(rise, 1.f) / (1 + 0.25f * std::max(0.f, rise - 2));
  }
  return std::min(1.f, sum / static_cast<float>(around.place.size()) * 1.6f);
}

} // namespace

Image draw_scene(const Scene& scene, const RasterOptions& o, int threads) {
  Samples s{o.width * o.samples, o.height * o.samples, {}, {}};
  const size_t count = static_cast<size_t>(s.width) * static_cast<size_t>(s.height);
  s.depth.resize(count);
  s.colour.resize(count);
  const int bands = (s.height + band_rows - 1) / band_rows;
  const Bins bins = bins_of(scene, o.samples, s.height, bands);
  par::for_n(bands, threads, 1, [&](int64_t b) {
    const int first = static_cast<int>(b) * band_rows, last = std::min(s.height, first + band_rows) - 1;
    const int64_t from = int64_t{first} * s.width, to = int64_t{last + 1} * s.width;
    std::fill(s.depth.begin() + from, s.depth.begin() + to, far_away);
    std::fill(s.colour.begin() + from, s.colour.begin() + to, o.background);
    Band band(scene, s, o.samples, first, last);
    for (int64_t k = bins.start[static_cast<size_t>(b)]; k < bins.start[static_cast<size_t>(b) + 1]; ++k)
      band.draw(scene.facet[bins.facet[k]]);
  });
  Image image(o.width, o.height, o.background);
  const Surroundings around(o.samples);
  par::for_n(o.height, threads, 8, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < o.width; ++x) {
      int sum[3] = {0, 0, 0};
      for (int j = 0; j < o.samples; ++j)
        for (int i = 0; i < o.samples; ++i) {
          const Rgb c = s.colour[static_cast<size_t>(y * o.samples + j) * static_cast<size_t>(s.width) +
                                 static_cast<size_t>(x * o.samples + i)];
          sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
        }
      const float open = o.shade_hollows ? 1 - 0.6f * hidden(s, o.samples, around, x, y) : 1;
      uint8_t* const p = image.at(x, y);
      for (int k = 0; k < 3; ++k)
        p[k] = static_cast<uint8_t>(static_cast<float>(sum[k]) / static_cast<float>(o.samples * o.samples) * open +
                                    0.5f);
    }
  });
  return image;
}

} // namespace molmesh::picture
