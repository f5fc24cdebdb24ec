// The least spanning tree of a root and all tasks.
#pragma once

#include <cstddef>
#include <cstdint>

namespace muster {

// [prim1957], over all edges. The edge between tasks i and j costs legs[i * n + j] + p[i] + p[j], legs being symmetric,
// and that from the root costs root[j]. Writes for each task what the edge to its parent costs, and the parent; -1 is
// the root. Tasks that no edge reaches cost inf.
void spanning_tree(const double* legs, const double* root, const double* p, std::size_t n, double* joined,
                   std::int64_t* parent);

}  // namespace muster
