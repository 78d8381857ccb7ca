#include "exitance/methods/hierarchical/link_rounds.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/base/memory.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/error/tolerance/tolerance_law.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/methods/hierarchical/link_importance.hpp"

namespace exitance {
namespace {

/// Error tolerance of the first round, W/m^2 m. The fewer links a sum has (large requested errors, high orders), the
/// larger the error of a single link may be.
double first_error(const Hierarchy& h, double demand) {
    const double factor_of_few =
        std::clamp(std::sqrt(h.input.knobs.link_error / calibrated::first_round_fine), 1.0, 2.0);
    const double share = h.light.delivers()     ? calibrated::first_round_delivering
                         : h.basis.order() == 3 ? calibrated::first_round_order_three
                                                : 1;
    return share * factor_of_few * demand;
}

/// If links are judged by their strength: limit on it in the first round, proportional to the error.
double first_strength(const Hierarchy& h, double error) {
    return h.input.options.oracle == LinkOracle::form_factor
               ? calibrated::first_form_factor * error / h.light_norm()
               : calibrated::first_strength * error * std::sqrt(h.input.stage.area);
}

/// Weight of the residual of a source's polynomial. Bilinear sources have large errors near receivers, all with one
/// sign; that is irrelevant if rays correct the light.
double residual_weight(const Hierarchy& h) {
    constexpr double default_weight = 0.5;
    return h.light.delivers() && h.basis.order() == 2 ? calibrated::residual_weight_of_bilinear : default_weight;
}

/// Ratio of the permitted error of links to that of the method. If rays correct the means of leaves, links determine
/// only the variation within them, and light is gathered once more. If links deliver the light, no gather takes a share
/// of the error.
double share_of_links(const Hierarchy& h) {
    if (h.light.delivers()) return h.input.options.epsilon ? 1 : calibrated::link_error_without_gather;
    return h.input.options.smoothing ? 1 : calibrated::link_error_under_rays;
}

/// Number of links that fit into memory.
std::size_t max_links(const Hierarchy& h) {
    constexpr std::size_t default_memory = 8'000'000'000;  // bytes; default limit
    const std::size_t used = peak_memory_bytes(),
                      limit = h.input.options.memory_limit_bytes.value_or(used + default_memory);
    // links get half of the memory; the other half is for meshes, gathers and files
    constexpr std::size_t others_share = 2;
    constexpr std::size_t fields = 7;  // fields of light and of the solver's vectors
    const std::size_t taken = used + fields * h.radiosity.memory_bytes();
    return (limit - std::min(limit, taken)) / (others_share * LinkRefiner::bytes_a_link);
}

/// Weight of an error that is uniform over the receivers: every reflection multiplies it unless rays correct it.
double systematic_weight(const Hierarchy& h) {
    if (!h.light.delivers()) return 1;
    constexpr double within_a_sum = 2;
    return within_a_sum * h.input.stage.expected_reflections();
}

/// The rounds of one solve.
class Rounds {
  public:
    explicit Rounds(Hierarchy& h)
        : h_(h), of_links_(first_exponent(h.light.delivers())), of_receivers_(first_exponent(h.light.delivers())) {
        // If rays correct the links, every round judges links by light reflected once; otherwise by all light found so
        // far.
        if (!h.light.delivers() && !has_importance_) h.refiner.keep_light();
        const double first = (has_importance_ ? calibrated::first_round_before_importance : 1) *
                             first_error(h, h.input.knobs.link_error * h.light_norm());
        tolerance_ = link_tolerance(h, first);
        tolerance_.oracle = h.input.options.oracle;
        tolerance_.residual_weight = residual_weight(h);
        tolerance_.corrected = !h.light.delivers();
        tolerance_.strongest = first_strength(h, first);
    }

    bool run() {
        constexpr int max_rounds = 8;
        const auto state = [&](auto& a) { archive_state(a); };
        SafePoints safe_points = h_.input.safe_points;
        safe_points.resume(state);
        for (; round_ < max_rounds; ++round_) {
            safe_points.pass(state);
            h_.input.progress.phase("link");
            const double judged_by = h_.light_norm();
            h_.refine(tolerance_);
            if (tolerance_.gives_up && h_.input.stop.requested()) return false;
            relax();
            // Errors of links grow with the light, of which the first round has only one reflection. That is irrelevant
            // if rays correct it.
            const double growth = h_.light.delivers() ? h_.light_norm() / judged_by : 1;
            const double by_link = growth * h_.link_error(), by_receiver = growth * h_.refiner.interpolation_error();
            if (is_good_enough(by_link, by_receiver)) break;
            lower_tolerances(by_link, by_receiver);
            if (!h_.light.delivers() && !has_importance_) h_.radiosity = h_.reflected_direct;
        }
        return true;
    }

  private:
    /// If links deliver light, the part of it that comes from reflections converges first.
    static double first_exponent(bool delivers) {
        return delivers ? calibrated::first_exponent_delivering : calibrated::first_exponent_gathered;
    }

    template <class Archive>
    void archive_state(Archive& a) {
        a(round_, tolerance_, h_.light.tree, h_.light.report);
        of_links_.archive_state(a), of_receivers_.archive_state(a);
        h_.sites.archive_state(a);
        for (NodalField* field : {&h_.reflected_direct, &h_.radiosity}) field->archive_state(a);
        h_.refiner.archive_state(a);
        if (h_.far) h_.far->archive_state(a);
    }

    void relax() {
        h_.input.progress.phase("solve");
        h_.light.numbering = LeafNumbering(h_.light.tree);
        h_.system.set_links(h_.refiner.make_links(), h_.far ? std::optional(h_.far->make_links()) : std::nullopt);
        h_.relax();
        if (has_importance_) h_.refiner.set_importance(find_link_importance(h_));
    }

    bool is_good_enough(double by_link, double by_receiver) {
        const double error = std::hypot(by_link, by_receiver), norm = h_.light_norm();
        demand_ = h_.input.knobs.link_error * share_of_links(h_) * norm;
        h_.input.progress.note(
            fmt::format("{} links, {} of clusters ({:.0f}% of their light in the open), {} elements, {} rays; "
                        "their error {:.3f}% "
                        "of {:.3f}%",
                        h_.refiner.size(), h_.far ? h_.far->size() : 0, 100 * h_.open_share(), h_.light.tree.size(),
                        h_.rays(), 100 * error / norm, 100 * demand_ / norm));
        h_.light.limited_by_memory = h_.refiner.is_limited();
        if (h_.input.stop.requested() || h_.light.limited_by_memory) return true;
        const bool knows_all_light = round_ > 0 || (!has_importance_ && !h_.light.delivers());
        return knows_all_light && error <= (h_.light.delivers() ? 1 : calibrated::accepted_link_excess) * demand_;
    }

    /// Lowers both tolerances. The squared error of the links and that of the receivers may each be half of the
    /// permitted square, plus the part of the other half that is not used.
    void lower_tolerances(double by_link, double by_receiver) {
        const auto beside = [&](double other) {
            return std::sqrt(demand_ * demand_ - std::min(other * other, 0.5 * demand_ * demand_));
        };
        const double links = of_links_.factor(by_link, beside(by_receiver)),
                     receivers = of_receivers_.factor(by_receiver, beside(by_link));
        tolerance_.error *= links, tolerance_.interpolation *= receivers;
        tolerance_.strongest *= std::min(links, receivers);
    }

    Hierarchy& h_;
    const bool has_importance_ = !h_.input.options.importance.empty();
    LinkTolerance tolerance_;
    ToleranceLaw of_links_, of_receivers_;
    int round_ = 0;
    double demand_ = 0;  ///< Permitted error of all links together, W/m^2 m.
};

}  // namespace

LinkTolerance link_tolerance(const Hierarchy& h, double error) {
    const SolveOptions& o = h.input.options;
    return {.error = error,
            .interpolation = error,
            .systematic = systematic_weight(h),
            .max_links = max_links(h),
            .min_area = o.min_area.value_or(calibrated::min_link_area * h.input.stage.area),
            .fractional = o.visibility == VisibilityKind::fractional,
            .quadrature = o.visibility == VisibilityKind::quadrature,
            .gives_up = h.input.may_give_up,
            // with glass only rays test visibility, since triage ignores panes
            .triage = o.triage && h.input.stage.scene.panes().empty(),
            .seed = o.seed};
}

bool refine_links(Hierarchy& hierarchy) {
    return Rounds(hierarchy).run();
}

}  // namespace exitance
