// tiles.cpp — compares tiles with the first, and keeps their leaves compressed.
#include "formats/vdb/tiles.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <sstream>

namespace molmesh::formats {
namespace {

std::string text(double x) {
  std::ostringstream s;
  s.precision(12);
  s << x;
  return s.str();
}
std::string text(int64_t n) {
  return std::to_string(n);
}
std::string text(const std::string& s) {
  return "'" + s + "'";
}
std::string text(Vec3i p) {
  return std::to_string(p.x) + " × " + std::to_string(p.y) + " × " + std::to_string(p.z);
}
std::string text(Vec3d p) {
  return "(" + text(p.x) + " " + text(p.y) + " " + text(p.z) + ")";
}

} // namespace

void TileJoin::check_same(const BlockGrid& grid, const VdbExtras& extras, const std::string& file) const {
  const auto same = [&](const char* name, const auto& found, const auto& expected) {
    if (!(found == expected))
      fail_input(file + ": " + name + " " + text(found) + ", expected " + text(expected) + " as in " +
                 (file_.empty() ? file : file_.front().second));
  };
  const FieldInfo &a = grid.info, &b = info_;
  same("source", a.source, b.source);
  same("atoms", a.atoms, b.atoms);
  same("levels", a.levels, b.levels);
  same("surface", extras.surface, extras_.surface);
  same("probe", extras.probe, extras_.probe);
  same("spacing", grid.frame.spacing, frame_.spacing);
  same("isovalue", a.isovalue, b.isovalue);
  same("decay", a.decay, b.decay);
  same("band_lower", a.band_lower, b.band_lower);
  same("band_upper", a.band_upper, b.band_upper);
  same("tolerance", a.tolerance, b.tolerance);
  same("inside_value", a.inside_value, b.inside_value);
  same("grid_points", grid.frame.points, frame_.points);
  same("grid_origin", grid.frame.lower, frame_.lower);
  same("translation", grid.frame.origin, frame_.origin);
  same("creator", a.creator, b.creator);
  same("number of tiles", int64_t{extras.tile.count}, int64_t{extras_.tile.count});
  if (extras.tile_digest != extras_.tile_digest)
    fail_input(file + ": tile of a run with other atoms, exponents or search options, expected those of " +
               file_.front().second);
}

void TileJoin::add(std::istream& in, const std::string& file) {
  VdbExtras extras;
  const BlockGrid grid = read_tile(in, file, leaves_.threads(), extras);
  if (file_.empty()) {
    frame_ = grid.frame;
    info_ = grid.info;
    info_.analyzed_points = 0;
    extras_ = extras;
  }
  check_same(grid, extras, file);
  const auto at = std::lower_bound(file_.begin(), file_.end(), std::pair{extras.tile.number, std::string()});
  if (at != file_.end() && at->first == extras.tile.number)
    fail_input(file + ": tile " + std::to_string(extras.tile.number) + " of " + std::to_string(extras.tile.count) +
               " as in " + at->second + ", expected each once");
  file_.insert(at, {extras.tile.number, file});
  info_.analyzed_points += grid.info.analyzed_points;
  leaves_.add(grid);
  inside_.insert(inside_.end(), grid.inside.begin(), grid.inside.end());
}

void TileJoin::check_complete() const {
  if (file_.empty())
    fail_input("no tile, expected one file at least");
  const int32_t count = extras_.tile.count;
  const auto missing = static_cast<int64_t>(count) - static_cast<int64_t>(file_.size());
  if (missing > 0) {
    std::string numbers;
    size_t shown = 0;
    auto at = file_.begin();
    for (int32_t n = 1; n <= count && shown < 8; ++n)
      if (at != file_.end() && at->first == n)
        ++at;
      else
        numbers += (shown++ ? ", " : "") + std::to_string(n);
    fail_input(file_.front().second + ": a tile of " + std::to_string(count) + ", of which " +
               (missing == 1 ? "number " : std::to_string(missing) + " are missing (") + numbers +
               (missing == 1                            ? " is missing"
                : missing > static_cast<int64_t>(shown) ? " …)"
                                                        : ")") +
               ", expected all");
  }
  if (leaves_.size() == 0)
    fail_input(file_.front().second +
               ": no tile has a block, expected a surface in one of them: a lower isovalue, a "
               "smaller spacing or a larger margin");
}

void TileJoin::write(std::ostream& out) const {
  VdbExtras whole = extras_;
  whole.tile = {};
  write_vdb(out, frame_, info_, inside_, leaves_, whole);
}

} // namespace molmesh::formats
