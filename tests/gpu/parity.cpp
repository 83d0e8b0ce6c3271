// parity.cpp — each stage by the device and by the host: on random small cases, on a structure, with little memory.
#include "parity.hpp"
#include "unit/contour/octree_forms.hpp"
#include "unit/density/oracle.hpp"
#include <cstdio>
#include <random>

namespace molmesh::gpu {

void Parity::tell(const std::string& what, const std::string& fault) {
  std::printf("%-6s %s%s%s\n", fault.empty() ? "ok" : "FAILED", what.c_str(), fault.empty() ? "" : ": ",
              fault.c_str());
  std::fflush(stdout);
  failures_ += !fault.empty();
}

namespace {

/// With a third of the memory that it took: slabs of the density, pages of the rest.
How with_little_memory(How how, const Timed& t) {
  how.most_bytes = t.device.most_used.own / 3;
  return how;
}
std::string unless_paged(const Timed& t) {
  return t.device.note.empty() ? "nothing was paged" : "";
}

} // namespace

void Parity::structure(const std::string& name, const Hierarchy& h, const density::Options& o, Stage last) {
  Timed t;
  const BlockGrid host = run_density(h, o, reference_, t);
  tell(name + ", density", compare_grids(h, run_density(h, o, device_, t), host));
  if (last == Stage::density)
    return;
  for (const double adapt : {contour::default_adapt(host.frame.spacing), 0.0}) {
    contour::Options c;
    c.meshed = contour::Options::both;
    c.adapt = adapt;
    const std::string what = name + ", mesh, --adapt " + std::to_string(adapt);
    TetMesh mesh;
    try {
      mesh = run_contour(host, c, reference_, t);
    } catch (const Error& e) { // beyond the host's own limits
      std::printf("none   %s: %s\n", what.c_str(), e.what());
      continue;
    }
    tell(what + ", " + std::to_string(mesh.tet.size()) + " tetrahedra",
         compare_meshes(run_contour(host, c, device_, t), mesh, 0));
    const TetMesh paged = run_contour(host, c, with_little_memory(device_, t), t);
    tell(what + ", with little memory", compare_meshes(paged, mesh, 0) + unless_paged(t));
    if (adapt == 0 || last == Stage::mesh)
      continue;
    const TetMesh better = run_improve(mesh, host, reference_, t), same = run_improve(mesh, host, device_, t);
    tell(name + ", improved", compare_meshes(same, better, 1e-6));
    tell(name + ", improved, valid", check_valid(same));
    const How little = with_little_memory(device_, t);
    const TetMesh by_pages = run_improve(mesh, host, little, t);
    tell(name + ", improved, with little memory", compare_meshes(by_pages, same, 0) + unless_paged(t));
  }
}

void Parity::slabs(const std::string& name, const Hierarchy& h, const density::Options& o, bool must_fit) {
  Timed t;
  const BlockGrid grid = run_density(h, o, device_, t);
  try {
    const BlockGrid slabs = run_density(h, o, with_little_memory(device_, t), t);
    tell(name + ", density in slabs",
         slabs.value == grid.value && slabs.active == grid.active ? "" : "other values than of a whole");
  } catch (const cuda::OutOfRoom& e) { // the molecule itself is not cut
    tell(name + ", density in slabs: too small for a third of its memory", must_fit ? e.what() : "");
  }
}

void Parity::random_grids(int step) {
  std::mt19937_64 random(5);
  int64_t tets = 0, meshes = 0;
  std::string fault;
  for (int trial = 0; trial < 24; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    if (trial % step != 0)
      continue;
    for (const double adapt : {0.0, 0.3})
      for (const bool cut : {false, true}) {
        contour::Options c;
        c.meshed = contour::Options::both;
        c.adapt = adapt;
        if (cut) { // a quarter of a spacing within the grid
          const Vec3d last = grid.frame.position(grid.frame.lower + grid.frame.points - Vec3i{1, 1, 1});
          const double in = 1.25 * grid.frame.spacing;
          c.box.kind = contour::BoxRequest::corners;
          c.box.lower = grid.frame.position(grid.frame.lower) + Vec3d{in, in, in};
          c.box.upper = last - Vec3d{in, in, in};
        }
        Timed t;
        const TetMesh host = run_contour(grid, c, reference_, t), mesh = run_contour(grid, c, device_, t);
        ++meshes;
        tets += static_cast<int64_t>(host.tet.size());
        if (fault.empty())
          fault = t.device.note.empty() ? compare_meshes(mesh, host, 0) : t.device.note;
      }
  }
  tell(std::to_string(meshes) + " meshes of random grids, " + std::to_string(tets) + " tetrahedra, to the last bit",
       fault);
}

void Parity::forms() {
  const auto compare = [&](const std::string& name, const BlockGrid& grid, const contour::Options& o) {
    Timed t;
    const TetMesh host = run_contour(grid, o, reference_, t);
    tell(name + ", " + std::to_string(host.tet.size()) + " tetrahedra, to the last bit",
         compare_meshes(run_contour(grid, o, device_, t), host, 0));
    return host;
  };
  const BlockGrid ball = test::ball_grid();
  for (const auto& [name, options] : test::octree_forms()) {
    const TetMesh mesh = compare("mesh of a ball with " + name, ball, options);
    if (!mesh.sphere)
      continue;
    Timed t;
    tell("the same, improved",
         compare_meshes(run_improve(mesh, ball, device_, t), run_improve(mesh, ball, reference_, t), 1e-6));
  }
  compare("mesh of a thin body", test::thin_body_grid(), test::plain_form());
}

void Parity::tiny() {
  density::Options o;
  o.spacing = 1.5;
  structure("tiny", test::random_chains(1, 3, 6, {}, 5), o, Stage::improve);
}

void Parity::small(int step) {
  random_grids(step);
  forms();
  density::Options fine;
  fine.spacing = 0.5;
  Hierarchy lengthy = test::random_chains(3, 60, 8, {0.4, 1}, 3);
  for (Atom& a : lengthy.atom)
    a.center.x *= 4;
  slabs("random", lengthy, fine, true);
  const std::vector<std::vector<double>> settings = {{}, {0.5, 1}, {0.3, 1}, {0.05, 0.5}, {2, 1}, {0.8, 0.5, 1}};
  for (size_t i = 0; i < settings.size(); i += static_cast<size_t>(step))
    for (const double tolerance : {1e-4, 1e-6}) {
      density::Options o;
      o.spacing = 0.8;
      o.tolerance = tolerance;
      structure("random " + std::to_string(i) + ", tolerance " + std::to_string(tolerance),
                test::random_chains(3, 12, 6, settings[i], 17 + static_cast<unsigned>(i)), o,
                tolerance == 1e-4 ? Stage::improve : Stage::density);
    }
}

} // namespace molmesh::gpu
