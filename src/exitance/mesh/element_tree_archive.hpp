#pragma once

#include "exitance/base/archive.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A tree as its roots and how each element was cut, from which the same tree comes again, bit for bit.
void archive(ArchiveWriter& a, const ElementTree& tree);
void archive(ArchiveReader& a, ElementTree& tree);

}  // namespace exitance
