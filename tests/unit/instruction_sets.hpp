// instruction_sets.hpp — repeats a test with every instruction set that the machine and the kernels have.
#pragma once
#include <catch2/catch.hpp>
#include <hwy/targets.h>

namespace molmesh::test {

template <class Test>
void with_every_instruction_set(Test&& test) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    test();
  }
  hwy::SetSupportedTargetsForTest(0);
}

} // namespace molmesh::test
