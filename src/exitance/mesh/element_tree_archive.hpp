#pragma once

#include "exitance/base/archive.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Stores a tree as its roots and splits, from which the reader reconstructs the same tree bit for bit.
void archive(ArchiveWriter& a, const ElementTree& tree);
void archive(ArchiveReader& a, ElementTree& tree);

}  // namespace exitance
