#include "exitance/methods/plan/method_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/available_memory.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/shooting_setup.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

/// Memory per pair of leaves with galerkin1 to 3, bytes, if two thirds of the pairs are links: their blocks while links
/// are created, the sorted links, and the copy that is sorted. Measured in the Cornell box at 1% (2,679 leaves): 36, 50
/// and 55; in a room with chairs, where a third of the pairs are links: 20.
constexpr double bytes_a_galerkin_pair = 60;

}  // namespace

double method_bytes(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves) {
    if (const auto own = entry_of(options.method, form_of(options)).forecast)
        return own(stage, options, knobs, 1, true).bytes;
    const double pairs = leaves * leaves;
    const double bytes_a_ray = sizeof(float) + (stage.glass.empty() ? 0 : sizeof(Spectrum));
    switch (options.method) {
        case Method::progressive:
        case Method::substructuring:
            return std::min(static_cast<double>(column_memory_bytes(options)), sizeof(float) * pairs);
        case Method::matrix:
            break;
        default:
            return bytes_a_ray * leaves * knobs.solve_rays.average;
    }
    if (options.bounces < 0 && options.basis && is_galerkin(*options.basis)) return bytes_a_galerkin_pair * pairs;
    switch (options.form_factors.value_or(FormFactorKind::ray_cast)) {
        case FormFactorKind::analytic:  // entries lead to patches one level above the leaves
            return sizeof(float) * pairs / 4;
        case FormFactorKind::hemicube:
            return (sizeof(float) + sizeof(std::uint32_t)) * pairs;
        default:
            return bytes_a_ray * leaves * knobs.solve_rays.average;
    }
}

Result<void> check_method_memory(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves) {
    // Processes share the memory of a node, and methods that run on several processes distribute their links.
    if (processes() > 1) return {};
    const double used = static_cast<double>(resident_memory_bytes());
    const double limit = options.memory_limit_bytes ? static_cast<double>(*options.memory_limit_bytes)
                                                    : used + static_cast<double>(available_memory_bytes());
    const double needed = method_bytes(stage, options, knobs, leaves);
    if (used + needed <= limit) return {};
    return Error{
        ErrorCode::limit,
        fmt::format("the method {}{} needs about {:.0f} MiB on {:.0f} elements, on top of {:.0f} MiB in use; {} {:.0f} "
                    "MiB",
                    name_in(method_names, options.method),
                    options.basis ? fmt::format(" with basis {}", name_in(basis_names, *options.basis)) : "",
                    std::ceil(needed / 0x1p20), leaves, std::ceil(used / 0x1p20),
                    options.memory_limit_bytes ? "the limit is" : "the machine has", std::floor(limit / 0x1p20)),
        options.memory_limit_bytes ? "--memory-limit" : "memory",
        options.method == Method::growing_cells
            ? "choose a smaller --max-units, a larger --error or another method"
            : "choose a larger --error or --mesh-size, or a method whose memory grows in proportion to the elements "
              "(--method hierarchical, or matrix without --basis galerkin and --form-factors)"};
}

}  // namespace exitance
