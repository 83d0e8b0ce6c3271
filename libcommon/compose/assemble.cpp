// assemble.cpp — finds what copies have in common: lattice, frame, band, metadata.
#include "compose/assemble.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <sstream>

namespace molmesh::compose {
namespace {

void require_same(const char* what, double found, double expected, const Ingredient& a, const Ingredient& first) {
  if (std::abs(found - expected) <= 1e-9 * std::abs(expected))
    return;
  std::ostringstream s;
  s << a.file << ": " << what << ' ' << found << ", expected " << expected << " as in " << first.file;
  fail_input(s.str());
}

std::string kind(const Ingredient& i) {
  std::ostringstream s;
  s << i.surface;
  if (i.probe > 0)
    s << " (probe " << i.probe << " Å)";
  return s.str();
}

bool only_translates(const Rigid& m) {
  Rigid r = m;
  r.t = {};
  return r.is_identity();
}

/// Index shift of a copy that lies on the lattice at `origin`; false: it does not.
bool on_lattice(const Copy& c, Vec3d origin, Vec3i& shift) {
  if (!only_translates(c.place))
    return false;
  const GridFrame& f = c.of->grid.frame;
  const Vec3d u = (f.origin + c.place.t - origin) / f.spacing;
  for (int a = 0; a < 3; ++a) {
    if (!(std::abs(u[a]) < 1 << 28))
      fail(Status::usage,
           c.of->file + ": a piece would lie over 2^28 spacings from the first, expected a nearer place");
    shift[a] = static_cast<int32_t>(std::lround(u[a]));
    if (std::abs(u[a] - shift[a]) > 1e-4)
      return false;
  }
  return true;
}

/// What all that add and all that are subtracted know.
void set_band(FieldInfo& info, std::span<const Copy> copies, double lower, double upper, const Options& o) {
  const double v = info.isovalue;
  double lo = 0, hi = 1e300;
  int64_t added = 0;
  for (const Copy& c : copies) {
    const FieldInfo& i = c.of->grid.info;
    lo = std::max(lo, c.subtract ? v * v / i.band_upper : i.band_lower);
    hi = std::min(hi, c.subtract ? v * v / i.band_lower : i.band_upper);
    added += !c.subtract;
  }
  if (lower > 0) {
    if (lower < lo * (1 - 1e-12) || upper > hi * (1 + 1e-12)) {
      std::ostringstream s;
      s << "the pieces know densities from " << lo << " to " << hi << ", expected a band within that and not from "
        << lower << " to " << upper;
      fail(Status::usage, s.str(), {"band"});
    }
    lo = lower, hi = upper;
  } else if (o.combine == Combine::sum && added > 1) {
    lo = std::max(lo, 0.9 * v);
  }
  if (o.combine == Combine::sum && added > 1 && o.unknown > 1 - lo / v) {
    std::ostringstream s;
    s << "a share of " << o.unknown << " isovalues may be missing, expected at most " << 1 - lo / v
      << ", from the band's lower limit to the isovalue";
    fail(Status::usage, s.str(), {"unknown", "band"});
  }
  info.band_lower = lo;
  info.band_upper = hi;
}

/// "3 x a.pdb sha256:… + b.pdb sha256:…"; that of a single source as it is.
std::string joined_source(std::span<const Copy> copies) {
  std::vector<std::string> order;
  std::map<std::string, int64_t> count;
  for (const Copy& c : copies)
    if (count[c.of->grid.info.source]++ == 0)
      order.push_back(c.of->grid.info.source);
  if (copies.size() == 1)
    return order[0];
  std::string all;
  for (const std::string& s : order)
    all +=
        (all.empty() ? "" : " + ") + (count[s] > 1 ? std::to_string(count[s]) + " x " : "") + (s.empty() ? "?" : s);
  return all;
}

} // namespace

Assembly assemble(std::span<const Copy> copies, double band_lower, double band_upper, const Options& options) {
  Assembly all;
  const Ingredient& first = *copies[0].of;
  FieldInfo info = first.grid.info;
  info.atoms = info.analyzed_points = 0;
  for (const Copy& c : copies) {
    const FieldInfo& i = c.of->grid.info;
    require_same("a spacing of", c.of->grid.frame.spacing, first.grid.frame.spacing, *c.of, first);
    require_same("an isovalue of", i.isovalue, first.grid.info.isovalue, *c.of, first);
    require_same("a decay rate of", i.decay, first.grid.info.decay, *c.of, first);
    if (c.of->surface != first.surface || c.of->probe != first.probe)
      fail_input(c.of->file + ": a " + kind(*c.of) + " surface, expected " + kind(first) + " as in " + first.file);
    if (options.combine == Combine::sum && copies.size() > 1 && first.surface != gaussian && !c.subtract &&
        &c != &copies[0])
      fail(Status::usage,
           c.of->file + ": densities of a " + first.surface + " surface do not add up, expected the union",
           {"combine"});
    info.inside_value = std::max(info.inside_value, i.inside_value);
    info.analyzed_points += i.analyzed_points;
    if (!c.subtract)
      info.atoms += i.atoms;
    if (i.levels != info.levels)
      info.levels.clear();
    all.resampling_error = std::max(all.resampling_error, c.of->resampling_error);
  }
  info.source = joined_source(copies);
  set_band(info, copies, band_lower, band_upper, options);
  info.inside_value = static_cast<float>(std::max(info.inside_value, info.band_upper));

  Vec3d origin = first.grid.frame.origin;
  if (only_translates(copies[0].place))
    origin += copies[0].place.t;
  std::vector<Placed> placed;
  std::vector<std::unique_ptr<BlockGrid>> resampled;
  GridFrame frame{origin, first.grid.frame.spacing, {}, {}};
  Vec3i end;
  for (const Copy& c : copies) {
    Placed p{&c.of->grid, {}, c.of->tail, c.subtract};
    p.name = c.of->file;
    if (on_lattice(c, origin, p.shift)) {
      ++all.copied;
    } else {
      ++all.resampled;
      ResamplingError e;
      p.shift = {};
      p.body = &c.of->grid;
      p.to_body = index_motion(c.of->grid.frame, c.place, origin);
      p.grid =
          resampled
              .emplace_back(std::make_unique<BlockGrid>(resample(c.of->grid, c.place, origin, options.threads, e)))
              .get();
      all.worst.value = std::max(all.worst.value, e.value);
      all.worst.distance = std::max(all.worst.distance, e.distance);
      all.worst.distance_99 = std::max(all.worst.distance_99, e.distance_99);
    }
    if (!c.subtract) {
      // One point more on each side, so that no cell of the band touches a wall; none where the grid stays as it
      // is.
      const Vec3i more = copies.size() > 1 ? Vec3i{1, 1, 1} : Vec3i{}, lo = p.grid->frame.lower + p.shift,
                  hi = lo + p.grid->frame.points;
      for (int a = 0; a < 3; ++a) {
        frame.lower[a] = placed.empty() ? lo[a] - more[a] : std::min(frame.lower[a], lo[a] - more[a]);
        end[a] = placed.empty() ? hi[a] + more[a] : std::max(end[a], hi[a] + more[a]);
        if (int64_t{end[a]} - frame.lower[a] > 1 << 29)
          fail(Status::usage, "the whole would have more than 2^29 points along an axis, expected nearer pieces");
      }
    }
    placed.push_back(p);
  }
  frame.points = end - frame.lower;
  all.resampling_error = std::max(all.resampling_error, all.worst.value);
  all.grid = join(frame, info, placed, options, all.counts);
  if (all.grid.corner.empty())
    fail(Status::failed, "nothing is left: the whole has no surface");

  // A sum of bounds is one, if every copy's body is part of the whole's.
  all.tail = first.tail;
  for (size_t i = 1; i < copies.size(); ++i) {
    const Tail& t = copies[i].of->tail;
    if (copies[i].subtract || !t.known() || !all.tail.known()) {
      all.tail = {};
      break;
    }
    const double high = std::max(all.tail.log, t.log);
    all.tail = {high + std::log(std::exp(all.tail.log - high) + std::exp(t.log - high)),
                std::min(all.tail.decay, t.decay), std::min(all.tail.radius, t.radius),
                std::max(all.tail.depth, t.depth)};
  }
  if (all.resampled > 0) // its body is known to a spacing or so
    all.tail = {};
  return all;
}

} // namespace molmesh::compose
