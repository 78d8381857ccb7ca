#include "exitance/reconstruct/interpolant.hpp"

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {
namespace {

/// What one leaf's samples say.
struct Fitted {
    std::array<Spectrum, 4> corners;
    double misfit_squared = 0;  ///< Mean over the leaf and the bands of (rho (E - polynomial))^2.
};

class Interpolation {
  public:
    Interpolation(const Stage& stage, const ElementFunction& indirect, const InterpolantOptions& options)
        : stage_(stage),
          indirect_(indirect),
          options_(options),
          locator_(indirect.tree, stage.scene.regions().size()) {
        out_.tree = stage.make_elements({options.edge, 0});
        mean_area_ = stage.area / static_cast<double>(out_.tree.leaves().size());
    }

    ElementFunction run(InterpolantReport& report, const StopRequest& stop) {
        std::vector<ElementId> active = out_.tree.leaves();
        for (int depth = 0; !active.empty(); ++depth) {
            fitted_.resize(out_.tree.size());
            parallel_ranges(active.size(), 8, [&](std::size_t begin, std::size_t end) {
                DirectLight::Workspace workspace;
                ReceiverLight light;
                for (std::size_t i = begin; i < end; ++i) fitted_[active[i]] = fit(active[i], light, workspace);
            });
            report.interrupted = stop.requested();
            if (depth == options_.max_depth || report.interrupted || out_.tree.size() > options_.max_elements) break;
            active = split_where_needed(active);
        }
        finish(report);
        return std::move(out_);
    }

  private:
    /// How much an error of E counts: as much as the surface reflects, and a little on black ones, where E is still
    /// looked at.
    Spectrum weight(RegionId region) const {
        Spectrum w = stage_.scene.material(region).reflectance;
        for (double& v : w.value) v = std::max(v, 0.1);
        return w;
    }

    Fitted fit(ElementId e, ReceiverLight& light, DirectLight::Workspace& workspace) const {
        const Patch& patch = out_.tree.patch(e);
        const RegionId region = out_.tree.region(e);
        const Normal& n = stage_.scene.regions()[region].plane.n;
        const std::vector<WeightedPlace> rule = element_rule(out_.tree, e, RuleOrder::fine);
        if (options_.add_direct) stage_.direct.prepare(out_.tree.outline(e), n, region, light, workspace);
        std::vector<Spectrum> value(rule.size());
        for (std::size_t i = 0; i < rule.size(); ++i) {
            const Point x = patch.at(rule[i].uv);
            value[i] = indirect_.at(locator_.find(region, x));
            if (options_.add_direct) value[i] += stage_.direct.irradiance(light, x, workspace);
        }
        const ElementFit fit(out_.tree, e, rule, value);
        Fitted out;
        for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
        const Spectrum w = weight(region);
        for (std::size_t i = 0; i < rule.size(); ++i)
            out.misfit_squared +=
                rule[i].weight * squared(w * (value[i] - fit.at(rule[i].uv))) / static_cast<double>(bands);
        return out;
    }

    std::vector<ElementId> split_where_needed(const std::vector<ElementId>& active) {
        std::vector<ElementId> fresh;
        const double share = options_.tolerance * options_.tolerance * mean_area_;
        for (ElementId e : active) {
            if (out_.tree.area(e) * fitted_[e].misfit_squared <= share) continue;
            for (ElementId child : refine_element(out_.tree, e)) fresh.push_back(child);
        }
        return fresh;
    }

    void finish(InterpolantReport& report) {
        out_.first_value.resize(out_.tree.size());
        double error = 0;
        for (ElementId e : out_.tree.leaves()) {
            const Patch& patch = out_.tree.patch(e);
            out_.first_value[e] = static_cast<std::uint32_t>(out_.values.size());
            for (int i = 0; i < patch.corner_count(); ++i) {
                out_.add_value(fitted_[e].corners[static_cast<std::size_t>(i)]);
            }
            error += out_.tree.area(e) * fitted_[e].misfit_squared;
        }
        report.error = std::sqrt(error / stage_.area);
    }

    const Stage& stage_;
    const ElementFunction& indirect_;
    const InterpolantOptions& options_;
    ElementLocator locator_;
    ElementFunction out_;
    Field<ElementId, Fitted> fitted_;
    double mean_area_ = 0;
};

}  // namespace

ElementFunction make_interpolant(const Stage& stage, const ElementFunction& indirect,
                                 const InterpolantOptions& options, InterpolantReport& report,
                                 const StopRequest& stop) {
    return Interpolation(stage, indirect, options).run(report, stop);
}

}  // namespace exitance
