#include "exitance/methods/solve_report.hpp"

#include <fmt/format.h>

#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/methods.hpp"

namespace exitance {

void record_work(const GlobalLight& light, SolveStatistics& statistics) {
    statistics.iterations += light.report.iterations;
    statistics.rays += light.work.rays;
    statistics.form_factors += light.work.form_factors;
}

void record_method(const Stage& stage, const GlobalLight& light, bool has_links, SolveStatistics& statistics) {
    statistics.residual = light.report.residual;
    statistics.links = light.work.links;
    statistics.link_memory_bytes = light.work.link_memory_bytes;
    statistics.element_memory_bytes = light.work.element_memory_bytes;
    statistics.elements_by_level = light.work.elements_by_level;
    // Links found by rays connect constant elements, whatever basis the method has otherwise.
    const bool sharp = statistics.method == name_in(method_names, Method::discontinuity);
    if (has_links && !sharp && light.indirect_corners.empty()) statistics.basis = name_in(basis_names, BasisKind::haar);
    const double scale = light.mean_reflected(stage.area);
    statistics.standard_error = scale > 0 ? rms_standard_error(stage, light) / scale : 0;
}

void record_certificate(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                        SolveStatistics& statistics) {
    statistics.rays += certificate.rays;
    statistics.elements = light.tree.size() + delivered.tree.size();
    statistics.leaf_elements = light.numbering.leaves.size() + delivered.tree.leaves().size();
    if (certificate.points == 0) return;  // nothing reflects, or too little light was found for an estimate
    statistics.relative_error_estimate = certificate.estimate;
    statistics.relative_error_bound = certificate.bound;
    statistics.relative_error_estimate_worst_room = certificate.worst_room;
    statistics.relative_error_estimate_worst_body = certificate.worst_body;
    statistics.error_p99 = certificate.p99;
}

std::string describe(const Certificate& certificate, const GlobalLight& light, const ElementFunction& delivered,
                     const LocalPassReport& gathered) {
    const double scale = certificate.mean_reflected > 0 ? 100 / certificate.mean_reflected : 0;
    return fmt::format(
        "{} elements solved on, {} gathered on; mean reflected radiosity {:.4g}; error estimate {:.3f}%, "
        "bound {:.3f}%, residual {:.3f}%, error constant {:.2f}; method {:.3f}%, rays' noise {:.3f}%, "
        "interpolation {:.3f}%, both as measured {:.3f}%; rays {} + {} + {}",
        light.numbering.leaves.size(), delivered.tree.leaves().size(), certificate.mean_reflected,
        100 * certificate.estimate, 100 * certificate.bound, 100 * certificate.residual, certificate.constant,
        100 * certificate.method, scale * gathered.whole.noise, scale * gathered.whole.interpolation,
        100 * certificate.local, light.work.rays, gathered.rays, certificate.rays);
}

}  // namespace exitance
