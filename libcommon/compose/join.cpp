// join.cpp — the values of the whole, block by block, and what may be missing from them.
#include "compose/join.hpp"
#include "base/error.hpp"
#include "compose/draft.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

namespace molmesh::compose {
namespace {

struct IndexBox {
  Vec3i lo, hi; ///< both included

  void add(const IndexBox& b) {
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], b.lo[a]);
      hi[a] = std::max(hi[a], b.hi[a]);
    }
  }
  IndexBox shifted(Vec3i by) const { return {lo + by, hi + by}; }
};
constexpr IndexBox nothing{{1 << 30, 1 << 30, 1 << 30}, {-(1 << 30), -(1 << 30), -(1 << 30)}};

/// In spacings; 0 where they overlap.
double distance(const IndexBox& a, const IndexBox& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({0, a.lo[axis] - b.hi[axis], b.lo[axis] - a.hi[axis]});
    sum += d * d;
  }
  return std::sqrt(sum);
}

IndexBox block_box(Vec3i corner) {
  return {corner, corner + Vec3i{7, 7, 7}};
}

/// What all placed copies of a grid share.
struct Source {
  const BlockGrid& g;
  BlockIndex index;
  std::vector<IndexBox> body; ///< of each block's points that are active or inside
  IndexBox all = nothing;

  Source(const BlockGrid& grid, int threads) : g(grid), index(grid), body(grid.corner.size(), nothing) {
    par::for_n(static_cast<int64_t>(body.size()), threads, 64, [&](int64_t b) {
      for (int s = 0; s < 512; ++s)
        if (g.active[8 * b + (s >> 6)] >> (s & 63) & 1 || g.value[512 * b + s] != 0) {
          const Vec3i p = g.corner[b] + within_block(s);
          body[b].add({p, p});
        }
    });
    for (const IndexBox& b : body)
      all.add(b);
  }
};

/// A block of the whole as one grid sees it.
struct View {
  enum Kind { outside, inside, mixed } kind = outside;
  float value[512];
  uint64_t active[8];

  bool is_active(size_t s) const { return active[s >> 6] >> (s & 63) & 1; }
};

class Part {
public:
  /// body: of what the tail says how far it reaches; most_beyond: the most where the grid tells "outside" alone.
  Part(const Placed& p, const Source& source, const Source& body, double most_beyond)
      : shift(p.shift), info(source.g.info), h_(source.g.frame.spacing), source_(source), body_(body),
        tail_(p.tail), to_body_(p.body ? p.to_body : translation(-to_double(p.shift))),
        box_(source.all.shifted(p.shift)),
        aligned_((p.shift.x & 7) == 0 && (p.shift.y & 7) == 0 && (p.shift.z & 7) == 0), turned_(p.body != nullptr),
        most_beyond_(most_beyond), name_(p.name) {
    if (tail_.known() && most_beyond_ > 0)
      reach_ = tail_.distance(1e-3 * info.tolerance);
  }

  /// Where this grid may have more than `value`: the box of its body and so much round it. Everywhere: unknown.
  IndexBox box_where(double value) const {
    constexpr int32_t most = 1 << 29;
    const double d = most_beyond_ <= value ? 0
                     : tail_.known()       ? tail_.distance(value) / h_ + (turned_ ? 2 : 0)
                                           : most;
    const auto n = static_cast<int32_t>(std::min<double>(std::ceil(d), most));
    return {box_.lo - Vec3i{n, n, n}, box_.hi + Vec3i{n, n, n}};
  }
  double most_beyond() const { return most_beyond_; }
  bool knows_tail() const { return tail_.known(); }
  const std::string& name() const { return name_; }
  /// Whether the blocks around may hold anything of this grid.
  bool near(const IndexBox& box) const { return distance(box, box_) == 0; }

  void view(Vec3i corner, View& v) const;
  /// Of a point whose block has no active point of this grid.
  bool inside(Vec3i p) const {
    return source_.index.find(p - shift) == BlockIndex::inside || lies_inside(p - shift);
  }
  bool active_in(Vec3i corner) const;
  const Source& source() const { return source_; }

  /// The most that this grid may have at points of `box` where it tells "outside" alone; body boxes near it are
  /// kept for beyond_at().
  double beyond(const IndexBox& box, std::vector<IndexBox>* nearby) const;
  double beyond_at(Vec3i p, const std::vector<IndexBox>& nearby) const;

  Vec3i shift;
  const FieldInfo& info;

private:
  bool lies_inside(Vec3i p) const {
    const int64_t b = source_.index.find(p);
    return b >= 0 && source_.g.value[512 * b + slot(p)] != 0;
  }
  double bound(double spacings) const {
    return tail_.known() ? std::min(most_beyond_, tail_.bound(spacings * h_)) : most_beyond_;
  }

  double h_;
  const Source &source_, &body_;
  Tail tail_;
  Rigid to_body_;
  IndexBox box_;
  bool aligned_, turned_;
  double most_beyond_, reach_ = 0; ///< Å
  std::string name_;
};

void Part::view(Vec3i corner, View& v) const {
  const BlockGrid& g = source_.g;
  const Vec3i from = corner - shift;
  const auto inside_value = static_cast<float>(info.inside_value);
  if (aligned_) {
    const int64_t b = source_.index.find(from);
    v.kind = b >= 0 ? View::mixed : b == BlockIndex::inside ? View::inside : View::outside;
    if (b < 0)
      return;
    std::copy_n(&g.value[512 * b], 512, v.value);
    std::copy_n(&g.active[8 * b], 8, v.active);
    return;
  }
  int64_t block[8];
  bool any = false, all_inside = true;
  for (int k = 0; k < 8; ++k) {
    block[k] = source_.index.find(from + Vec3i{k >> 2 ? 7 : 0, k >> 1 & 1 ? 7 : 0, k & 1 ? 7 : 0});
    any = any || block[k] != BlockIndex::outside;
    all_inside = all_inside && block[k] == BlockIndex::inside;
  }
  v.kind = !any ? View::outside : all_inside ? View::inside : View::mixed;
  if (v.kind != View::mixed)
    return;
  const Vec3i first = block_corner(from);
  for (int i = 0; i < 8; ++i) {
    uint64_t word = 0;
    for (int j = 0; j < 8; ++j) {
      const Vec3i p = from + Vec3i{i, j, 0};
      const int across = (p.x - first.x >= 8 ? 4 : 0) + (p.y - first.y >= 8 ? 2 : 0);
      for (int k = 0; k < 8; ++k) {
        const Vec3i q = p + Vec3i{0, 0, k};
        const int64_t b = block[across + (q.z - first.z >= 8 ? 1 : 0)];
        const int s = slot(q);
        v.value[64 * i + 8 * j + k] = b >= 0 ? g.value[512 * b + s] : b == BlockIndex::inside ? inside_value : 0;
        if (b >= 0)
          word |= (g.active[8 * b + (s >> 6)] >> (s & 63) & 1) << (8 * j + k);
      }
    }
    v.active[i] = word;
  }
}

/// A box round a box that is moved.
IndexBox moved(const IndexBox& box, const Rigid& motion, bool turns) {
  const Vec3d middle = motion(0.5 * (to_double(box.lo) + to_double(box.hi)));
  const Vec3d half = 0.5 * (to_double(box.hi) - to_double(box.lo));
  IndexBox out{};
  for (int a = 0; a < 3; ++a) {
    const double reach = turns ? std::abs(motion.row[a].x) * half.x + std::abs(motion.row[a].y) * half.y +
                                     std::abs(motion.row[a].z) * half.z
                               : half[a];
    out.lo[a] = static_cast<int32_t>(std::floor(middle[a] - reach + 1e-6));
    out.hi[a] = static_cast<int32_t>(std::ceil(middle[a] + reach - 1e-6));
  }
  return out;
}

double Part::beyond(const IndexBox& box, std::vector<IndexBox>* nearby) const {
  if (nearby)
    nearby->clear();
  if (!tail_.known())
    return most_beyond_;
  const IndexBox here = moved(box, to_body_, turned_);
  double least = distance(here, body_.all);
  const double reach = reach_ / h_;
  if (least >= reach)
    return bound(least);
  least = reach;
  const auto cells = static_cast<int32_t>(std::ceil(reach));
  const Vec3i first = block_corner(here.lo - Vec3i{cells, cells, cells}),
              last = here.hi + Vec3i{cells, cells, cells};
  for (int32_t x = first.x; x <= last.x; x += 8)
    for (int32_t y = first.y; y <= last.y; y += 8)
      for (int32_t z = first.z; z <= last.z; z += 8) {
        const int64_t b = body_.index.find({x, y, z});
        if (b == BlockIndex::outside)
          continue;
        const IndexBox body = b >= 0 ? body_.body[b] : block_box({x, y, z});
        if (const double d = distance(here, body); d < reach) {
          least = std::min(least, d);
          if (nearby)
            nearby->push_back(body);
        }
      }
  return bound(least);
}

double Part::beyond_at(Vec3i p, const std::vector<IndexBox>& nearby) const {
  if (!tail_.known())
    return most_beyond_;
  const Vec3d q = to_body_(to_double(p));
  double least = reach_ / h_;
  for (const IndexBox& b : nearby) {
    Vec3d d;
    for (int a = 0; a < 3; ++a)
      d[a] = std::max({0.0, b.lo[a] - q[a], q[a] - b.hi[a]});
    least = std::min(least, norm(d));
  }
  return bound(least);
}

/// A block of the whole while grids are joined to it.
struct Values {
  double g[512];   ///< where known
  double off[512]; ///< the most that g errs by, without what is missing
  double missing[512];
  uint8_t terms[512];
  bool inside[512];
};

class Joiner {
public:
  Joiner(const GridFrame& frame, const FieldInfo& info, std::span<const Placed> placed, const Options& o)
      : frame_(frame), info_(info), o_(o) {
    std::map<const BlockGrid*, const Source*> known;
    const auto source_of = [&](const BlockGrid& grid) -> const Source& {
      const Source*& s = known[&grid];
      if (!s)
        s = sources_.emplace_back(std::make_unique<Source>(grid, o.threads)).get();
      return *s;
    };
    for (const Placed& p : placed)
      (p.subtract ? subtracted_ : added_)
          .emplace_back(p, source_of(*p.grid), source_of(p.body ? *p.body : *p.grid),
                        o.combine == Combine::sum ? p.grid->info.band_lower : 0);
  }
  BlockGrid run(Counts& counts);

private:
  struct Outcome {
    int64_t shared = 0, refused = 0;
    double missing = 0, tolerance = 0;
    Vec3i where;
  };
  void find_blocks();
  bool is_inside(Vec3i p) const {
    const auto in = [&](const Part& part) { return part.inside(p); };
    return std::any_of(added_.begin(), added_.end(), in) &&
           std::none_of(subtracted_.begin(), subtracted_.end(), in);
  }
  void fill(int64_t b, Outcome& out);
  void add(const Part& part, const View& view, Values& v) const;
  void subtract(const Part& part, const View& view, Values& v) const;
  void note_missing(Vec3i corner, Values& v) const;
  void look_between(Outcome& out) const;
  [[noreturn]] void refuse(const Outcome& out) const;

  const GridFrame& frame_;
  FieldInfo info_;
  const Options& o_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Part> added_, subtracted_;
  Draft draft_;
};

/// Those with active points of any grid, and those that lie wholly inside.
void Joiner::find_blocks() {
  std::vector<Vec3i>&corner = draft_.corner, touched;
  const auto blocks_of = [](const IndexBox& box, auto&& use) {
    const Vec3i first = block_corner(box.lo);
    for (int32_t x = first.x; x <= box.hi.x; x += 8)
      for (int32_t y = first.y; y <= box.hi.y; y += 8)
        for (int32_t z = first.z; z <= box.hi.z; z += 8)
          use(Vec3i{x, y, z});
  };
  const auto collect = [&](const std::vector<Part>& parts, bool adds) {
    for (const Part& part : parts) {
      const BlockGrid& g = part.source().g;
      for (size_t b = 0; b < g.corner.size(); ++b) {
        IndexBox active = nothing;
        for (int i = 0; i < 8; ++i)
          if (const uint64_t word = g.active[8 * b + static_cast<size_t>(i)]) {
            uint64_t rows = word;
            for (const int by : {32, 16, 8})
              rows |= rows >> by;
            uint64_t lines = 0; // bit j: any in row j
            for (int j = 0; j < 8; ++j)
              lines |= uint64_t{(word >> 8 * j & 0xff) != 0} << j;
            const auto in_row = static_cast<uint32_t>(rows & 0xff), in_j = static_cast<uint32_t>(lines);
            active.add({g.corner[b] + Vec3i{i, std::countr_zero(in_j), std::countr_zero(in_row)},
                        g.corner[b] + Vec3i{i, 31 - std::countl_zero(in_j), 31 - std::countl_zero(in_row)}});
          }
        blocks_of(active.shifted(part.shift), [&](Vec3i c) { corner.push_back(c); });
        if (adds)
          blocks_of(block_box(g.corner[b]).shifted(part.shift), [&](Vec3i c) { touched.push_back(c); });
      }
      if (adds)
        for (const Vec3i c : g.inside)
          blocks_of(block_box(c).shifted(part.shift), [&](Vec3i d) { touched.push_back(d); });
    }
  };
  collect(added_, true);
  collect(subtracted_, false);
  par::sort_unique(corner, o_.threads);
  par::sort_unique(touched, o_.threads);
  std::vector<Vec3i> rest;
  std::set_difference(touched.begin(), touched.end(), corner.begin(), corner.end(), std::back_inserter(rest));
  std::vector<uint8_t> in(rest.size());
  par::for_n(static_cast<int64_t>(rest.size()), o_.threads, 256, [&](int64_t i) { in[i] = is_inside(rest[i]); });
  for (size_t i = 0; i < rest.size(); ++i)
    if (in[i])
      draft_.inside.push_back(rest[i]);
}

void Joiner::add(const Part& part, const View& view, Values& v) const {
  if (view.kind == View::outside)
    return;
  if (view.kind == View::inside) {
    std::fill(v.inside, v.inside + 512, true);
    return;
  }
  const bool sum = o_.combine == Combine::sum;
  for (size_t s = 0; s < 512; ++s) {
    const double g = view.value[s];
    if (!view.is_active(s)) {
      v.inside[s] = v.inside[s] || g != 0;
      continue;
    }
    const double off = part.info.tolerance * std::max(1.0, g);
    v.g[s] = sum ? v.g[s] + g : std::max(v.g[s], g);
    v.off[s] = sum ? v.off[s] + off : std::max(v.off[s], off);
    ++v.terms[s];
  }
}

void Joiner::subtract(const Part& part, const View& view, Values& v) const {
  if (view.kind == View::outside)
    return;
  const double v2 = info_.isovalue * info_.isovalue;
  for (size_t s = 0; s < 512; ++s) {
    const double b = view.kind == View::inside ? part.info.inside_value : view.value[s];
    if (view.kind == View::inside || !view.is_active(s)) {
      if (b != 0) {
        v.inside[s] = false;
        v.terms[s] = 0;
        v.g[s] = v.off[s] = v.missing[s] = 0;
      }
      continue;
    }
    const double g = v2 / b;
    if (!(g < 1e30) || (!v.inside[s] && (v.terms[s] == 0 || v.g[s] <= g)))
      continue;
    v.g[s] = g;
    v.off[s] = g / b * part.info.tolerance * std::max(1.0, b);
    v.missing[s] = 0;
    v.inside[s] = false;
    v.terms[s] = std::max<uint8_t>(v.terms[s], 1);
  }
}

/// Adds what grids that tell "outside" alone may have.
void Joiner::note_missing(Vec3i corner, Values& v) const {
  if (added_.size() < 2 || o_.combine == Combine::max)
    return;
  View view;
  std::vector<IndexBox> nearby;
  const IndexBox box = block_box(corner);
  double everywhere = 0;
  for (const Part& part : added_) {
    const double most = part.beyond(box, &nearby);
    view.kind = View::outside;
    if (part.near(box))
      part.view(corner, view);
    if (view.kind == View::inside)
      continue;
    // In few blocks it matters where in the block a point lies.
    const bool point_by_point = most > 0.1 * o_.unknown * info_.isovalue && !nearby.empty();
    if (view.kind == View::outside && !point_by_point) {
      everywhere += most;
      continue;
    }
    for (size_t s = 0; s < 512; ++s)
      if (!v.inside[s] && (view.kind == View::outside || (!view.is_active(s) && view.value[s] == 0)))
        v.missing[s] += point_by_point ? part.beyond_at(corner + within_block(static_cast<int>(s)), nearby) : most;
  }
  for (size_t s = 0; s < 512; ++s)
    v.missing[s] += everywhere;
}

void Joiner::fill(int64_t b, Outcome& out) {
  const Vec3i corner = draft_.corner[b];
  const IndexBox box = block_box(corner);
  Values v;
  std::fill(v.g, v.g + 512, 0.0);
  std::fill(v.off, v.off + 512, 0.0);
  std::fill(v.missing, v.missing + 512, 0.0);
  std::fill(v.terms, v.terms + 512, uint8_t{0});
  std::fill(v.inside, v.inside + 512, false);
  View view;
  for (const Part& part : added_)
    if (part.near(box)) {
      part.view(corner, view);
      add(part, view, v);
    }
  note_missing(corner, v);
  for (const Part& part : subtracted_)
    if (part.near(box)) {
      part.view(corner, view);
      subtract(part, view, v);
    }
  const double allowed = o_.unknown * info_.isovalue;
  const auto inside_value = static_cast<float>(info_.inside_value);
  float* const value = &draft_.value[512 * b];
  uint64_t* const known = &draft_.known[8 * b];
  std::fill(known, known + 8, uint64_t{0});
  for (size_t s = 0; s < 512; ++s) {
    value[s] = v.inside[s] ? inside_value : v.terms[s] > 0 ? static_cast<float>(v.g[s]) : 0;
    if (v.inside[s])
      continue;
    if (v.terms[s] > 0)
      known[s >> 6] |= uint64_t{1} << (s & 63);
    if (v.terms[s] > 0) {
      out.shared += v.terms[s] > 1;
      out.tolerance = std::max(out.tolerance, (v.off[s] + v.missing[s]) / std::max(1.0, v.g[s]));
    }
    if (v.terms[s] > 0 || v.g[s] + v.missing[s] > info_.isovalue) {
      if (v.missing[s] > out.missing)
        out.missing = v.missing[s], out.where = corner + within_block(static_cast<int>(s));
      out.refused += v.missing[s] > allowed;
    }
  }
}

/// Blocks without active points, near to two grids or more, whose tails could reach the isovalue together.
void Joiner::look_between(Outcome& out) const {
  double all = 0;
  for (const Part& part : added_)
    all += part.most_beyond();
  if (all <= info_.isovalue)
    return;
  const BlockGrid blocks{frame_, info_, draft_.corner, {}, {}, draft_.inside};
  const BlockIndex index(blocks);
  std::vector<Vec3i> gap;
  const double share = info_.isovalue / static_cast<double>(added_.size());
  for (size_t i = 0; i < added_.size(); ++i)
    for (size_t j = i + 1; j < added_.size(); ++j) {
      const IndexBox a = added_[i].box_where(share), b = added_[j].box_where(share);
      IndexBox box{};
      bool meet = true;
      for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::max({a.lo[axis], b.lo[axis], frame_.lower[axis]});
        box.hi[axis] = std::min({a.hi[axis], b.hi[axis], frame_.lower[axis] + frame_.points[axis] - 1});
        meet = meet && box.lo[axis] <= box.hi[axis];
      }
      if (!meet)
        continue;
      const Vec3i first = block_corner(box.lo);
      for (int32_t x = first.x; x <= box.hi.x; x += 8)
        for (int32_t y = first.y; y <= box.hi.y; y += 8)
          for (int32_t z = first.z; z <= box.hi.z; z += 8)
            if (index.find({x, y, z}) == BlockIndex::outside)
              gap.push_back({x, y, z});
    }
  par::sort_unique(gap, o_.threads);
  std::vector<double> most(gap.size());
  par::for_n(static_cast<int64_t>(gap.size()), o_.threads, 64, [&](int64_t i) {
    for (const Part& part : added_)
      most[i] += part.beyond(block_box(gap[i]), nullptr);
    if (most[i] > info_.isovalue) { // point by point
      Values v;
      std::fill(v.missing, v.missing + 512, 0.0);
      std::fill(v.inside, v.inside + 512, false);
      note_missing(gap[i], v);
      most[i] = *std::max_element(v.missing, v.missing + 512);
    }
  });
  for (size_t i = 0; i < gap.size(); ++i)
    if (most[i] > info_.isovalue) {
      ++out.refused;
      if (most[i] > out.missing)
        out.missing = most[i], out.where = gap[i];
    }
}

void Joiner::refuse(const Outcome& out) const {
  char text[400];
  for (const Part& part : added_)
    if (!part.knows_tail() && part.most_beyond() > o_.unknown * info_.isovalue) {
      std::snprintf(
          text, sizeof text,
          ": the file does not say how its density falls far from the surface (maps, resampled densities, "
          "atoms or bodies thinner than cells), so that up to %.3g of a sum may be missing, expected at "
          "most %.3g: a wider band, a finer grid, or the union",
          part.most_beyond(), o_.unknown * info_.isovalue);
      fail(Status::usage, part.name() + text, {"combine", "unknown"});
    }
  const Vec3d p = frame_.position(out.where);
  std::snprintf(
      text, sizeof text,
      "near (%.4g, %.4g, %.4g) Å pieces lie so close together that up to %.3g of their sum is not in the files, "
      "expected at most %.3g: pieces that know lower densities (a wider band), or the union",
      p.x, p.y, p.z, out.missing, o_.unknown * info_.isovalue);
  fail(Status::usage, text, {"combine", "unknown"});
}

BlockGrid Joiner::run(Counts& counts) {
  find_blocks();
  draft_.frame = frame_;
  const size_t n = draft_.corner.size();
  par::resize_pages(draft_.value, 512 * n, o_.threads);
  par::resize_pages(draft_.known, 8 * n, o_.threads);
  Outcome all;
  const auto merge = [](Outcome a, const Outcome& b) {
    a.shared += b.shared;
    a.refused += b.refused;
    a.tolerance = std::max(a.tolerance, b.tolerance);
    if (b.missing > a.missing)
      a.missing = b.missing, a.where = b.where;
    return a;
  };
  all = par::reduce(
      static_cast<int64_t>(n), o_.threads, Outcome{},
      [&](int64_t b) {
        Outcome out;
        fill(b, out);
        return out;
      },
      merge, 32);
  if (added_.size() > 1 && o_.combine == Combine::sum)
    look_between(all);
  if (all.refused > 0)
    refuse(all);
  counts.shared_points = all.shared;
  counts.largest_unknown = all.missing;
  info_.tolerance = all.tolerance;
  for (const Part& part : added_) // not a rounded quotient of it
    if (std::abs(all.tolerance - part.info.tolerance) < 1e-9 * all.tolerance)
      info_.tolerance = part.info.tolerance;
  draft_.info = info_;
  int64_t unknown = 0;
  BlockGrid grid = finish(std::move(draft_), o_.threads, unknown);
  if (unknown > 0)
    fail(Status::usage,
         std::to_string(unknown) + " corners of cells in the band are in no file: expected a band that all pieces "
                                   "know, or the union",
         {"band", "combine"});
  return grid;
}

} // namespace

BlockGrid join(const GridFrame& frame, const FieldInfo& info, std::span<const Placed> placed,
               const Options& options, Counts& counts) {
  return Joiner(frame, info, placed, options).run(counts);
}

} // namespace molmesh::compose
