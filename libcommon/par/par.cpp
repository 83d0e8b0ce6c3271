// par.cpp — sets the default number of threads.
#include "par/par.hpp"
#ifdef _OPENMP
#include <omp.h>
#endif

namespace molmesh::par {

bool has_threads() {
#ifdef _OPENMP
  return true;
#else
  return false;
#endif
}

int default_threads() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

} // namespace molmesh::par
