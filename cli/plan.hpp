// plan.hpp — what a run will take, told before the work, and the memory that it may take.
#pragma once
#include "base/control_groups.hpp"
#include "cli/options.hpp"
#include "cli/run.hpp"
#include "cli/value.hpp"
#include <cstdint>
#include <string>

namespace molmesh::cli {

/// Of a core, for each stage of the chain, where the machine of docs/benchmarks.md has 1.
struct Speeds {
  double hier2density = 1, density2tet = 1, tetsmooth = 1;
};

/// "2" for all, or "1.2,0.9,0.8" in the order of the chain, each > 0. Throws Error(usage) "WHERE: …".
Speeds speeds_of(const std::string& text, const std::string& where);

/// The options --plan, --json, --speed and --max-mem. A program's Options derives from it beside Common.
struct PlanOptions {
  bool plan = false, json = false;
  std::string speed = "auto";
  std::string max_mem = "auto";
  bool machine_limits = false; ///< where nothing is granted

  /// Bytes that the run may take; -1: no limit is known. auto: what the batch system grants, else, with
  /// machine_limits, what the machine has.
  int64_t memory_limit() const;
  /// auto: what MOLMESH_SPEED says, else 1.
  Speeds speeds() const;
  /// Throws Error(usage) where a text is no size or no speed: run_main() calls it.
  void check() const;
};

void add_plan_options(Table& table, PlanOptions& o);

/// "2G", "500M", "1.5T", "1000000" in bytes, K = 1024. Throws Error(usage).
int64_t bytes_of(const std::string& text);
/// "531 MB", as people read it: powers of ten, three digits.
std::string size_text(int64_t bytes);

/// "0.25 Å".
std::string length_text(double angstroms);

/// The least that control groups around this process grant, and SLURM_MEM_PER_NODE, which is in MiB. -1: neither.
int64_t granted_memory(const char* slurm_mem_per_node, const SystemFiles& system = {});

/// Memory and swap of the machine; -1: not known.
int64_t machine_memory(const SystemFiles& system = {});

/// Writes a plan to the program's output, as text or JSON: fields in order, whose values are numbers, words or such
/// fields again. Names that end in _bytes are sizes.
void write_plan(const Common& o, const PlanOptions& p, const Run& run, const Value& plan);

/// Throws Error(failed) where more is needed than may be taken. what: "the density at 0.25 Å"; instead: what would
/// fit ("--spacing 0.61 fits").
void require_memory(const PlanOptions& p, int64_t needed, const std::string& what, const std::string& instead);

} // namespace molmesh::cli
