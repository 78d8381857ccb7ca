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
    std::vector<std::size_t> counts{16, 64, 256, 1024};  ///< Of basis functions.
    std::size_t pairs = 100'000;
};

inline constexpr const char* kernel_error_header = "scene,pairs,row,seed,asked,functions,relative_error,bytes,seconds";

/// How well so many basis functions hold the kernel of a scene: rows under the header above.
/// `asked` is the number of functions that was wanted, `functions` what there is: links come in fours.
///
/// Pairs that touch are measured with the first seed alone. Pairs whose source emits: relative L2 of G V M over x of
/// all surfaces and y of emitters, both uniform in area. Pairs that touch (neither emits; the square of G has no
/// integral there): relative L1 of G V over pairs of reflecting surfaces. Rows: links of hierarchical radiosity
/// (constants G V on pairs of quadtree elements, the pair of the largest B F refined first, its larger element cut
/// [Hanrahan91]; V by 16 rays), growing cells as published (delta rule), the same with weights by least squares, and
/// visibility learned by linear maps times the analytic kernel.
void measure_kernel_error(const std::string& name, const Scene& scene, const KernelErrorOptions& options, CsvText& out,
                          const StopRequest& stop);

}  // namespace exitance
