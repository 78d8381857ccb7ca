#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/lab/thesis/csv_text.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

struct KernelErrorOptions {
    std::uint64_t seeds = 5;
    std::vector<std::size_t> counts{16, 64, 256, 1024};  ///< Numbers of basis functions.
    std::size_t pairs = 100'000;
};

inline constexpr const char* kernel_error_header = "scene,pairs,row,seed,asked,functions,relative_error,bytes,seconds";

/// Measures the error with which a number of basis functions represents the kernel of a scene: rows under the header
/// above. `asked` is the requested number of functions, `functions` the actual one: links come in fours.
///
/// Two sets of pairs of points are measured:
/// - Pairs whose source emits: relative L2 error of G V M, for x on all surfaces and y on emitters, both uniform in
///   area.
/// - Touching pairs, in which neither point emits (there the square of G has no integral): relative L1 error of G V
///   over pairs of reflecting surfaces; first seed only.
///
/// Rows:
/// - links of hierarchical radiosity (constant G V on pairs of quadtree elements; the pair with the largest B F is
///   refined first by splitting its larger element [Hanrahan91]; V by 16 rays),
/// - growing cells as published (delta rule),
/// - growing cells with weights by least squares,
/// - visibility learned by linear maps, times the analytic kernel.
void measure_kernel_error(const std::string& name, const Scene& scene, const KernelErrorOptions& options, CsvText& out,
                          const StopRequest& stop);

}  // namespace exitance
