#include "exitance/reconstruct/local_pass.hpp"

#include <bit>

#include "exitance/basis/element_fit.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/mesh/adaptive.hpp"

namespace exitance {
namespace {

/// What one element's gathers say.
struct Sampled {
    std::array<Spectrum, 4> corners;
    double noise_squared = 0;  ///< Of rho E at a node, mean over bands, (W/m^2)^2.
    double departure = 0;      ///< |rho (E - polynomial)| at the centre, mean over bands, W/m^2.
    unsigned rays = 0;         ///< Spent in all.
    unsigned node_rays = 0;    ///< Of one node, in the end.
};

class LocalPass {
  public:
    LocalPass(const Stage& stage, const RadiosityAt& b, const LocalPassOptions& options)
        : stage_(stage), b_(b), options_(options) {
        out_.tree = stage.make_elements(options.mesh);
        mean_area_ = stage.area / static_cast<double>(out_.tree.leaves().size());
    }

    ElementFunction run(LocalPassReport& report, Progress& progress, const StopRequest& stop) {
        std::vector<ElementId> active = out_.tree.leaves();
        for (int depth = 0; !active.empty(); ++depth) {
            sampled_.resize(out_.tree.size());
            // In slices, so that progress can be told and a request to stop is heard.
            const std::size_t slice = std::max<std::size_t>(64, active.size() / 32 + 1);
            for (std::size_t first = 0; first < active.size() && !stop.requested(); first += slice) {
                parallel_ranges(std::min(slice, active.size() - first), 4, [&](std::size_t begin, std::size_t end) {
                    GatherWorkspace workspace;
                    for (std::size_t i = first + begin; i < first + end; ++i)
                        sampled_[active[i]] = sample(active[i], workspace);
                });
                // The first round is about half of the work, every further one half of what is left.
                const double done = static_cast<double>(first) / static_cast<double>(active.size());
                progress.advance(1 - std::ldexp(1 - 0.5 * done, -depth));
            }
            for (ElementId e : active) report.rays += sampled_[e].rays;
            report.interrupted = stop.requested();
            if (depth == options_.max_depth || report.interrupted) break;
            active = split_where_needed(active);
        }
        finish(report);
        return std::move(out_);
    }

  private:
    /// Gathers with the rays that the element's area suggests, and once more with as many as the noise then asks for.
    Sampled sample(ElementId e, GatherWorkspace& workspace) const {
        const unsigned rays = std::max(4u, options_.rays.rays(out_.tree.area(e), mean_area_));
        Sampled out = sample(e, rays, workspace);
        const double allowed = options_.noise * std::pow(mean_area_ / out_.tree.area(e), 0.25);
        const double excess = std::sqrt(out.noise_squared) / allowed;
        if (!(excess > 1.5)) return out;
        const double factor = std::min(64.0, std::pow(excess, 4.0 / 3));
        const unsigned spent = out.rays;
        out = sample(e, std::min(options_.rays.most, std::bit_ceil(static_cast<unsigned>(rays * factor))), workspace);
        out.rays += spent;
        return out;
    }

    Sampled sample(ElementId e, unsigned rays, GatherWorkspace& workspace) const {
        const Patch& patch = out_.tree.patch(e);
        const RegionId region = out_.tree.region(e);
        const Normal& n = stage_.scene.regions()[region].plane.n;
        const Spectrum& rho = stage_.scene.material(region).reflectance;
        const auto gather = [&](Vec2 uv, std::uint64_t node) {
            const std::uint64_t key = hash(options_.seed, static_cast<std::uint64_t>(Stream::gather), e.value, node);
            return gather_reflected(stage_, patch.at(uv), n, region, rays, key, b_, workspace);
        };
        const std::vector<WeightedPlace> nodes = element_rule(out_.tree, e, RuleOrder::nodes);
        std::vector<Spectrum> value(nodes.size());
        Sampled out;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Gathered g = gather(nodes[i].uv, i);
            value[i] = g.irradiance;
            out.noise_squared += nodes[i].weight * mean(rho * rho * g.variance);
        }
        const ElementFit fit(out_.tree, e, nodes, value);
        for (int i = 0; i < patch.corner_count(); ++i) out.corners[static_cast<std::size_t>(i)] = fit.corner(i);
        const Vec2 centre = out_.tree.centre(e);
        const Spectrum departure = rho * (gather(centre, nodes.size()).irradiance - fit.at(centre));
        out.departure = std::sqrt(squared(departure) / static_cast<double>(bands));
        out.node_rays = rays;
        out.rays = rays * static_cast<unsigned>(nodes.size() + 1);
        return out;
    }

    /// Cuts the elements whose error has too large a share in the whole; returns the new leaves.
    std::vector<ElementId> split_where_needed(const std::vector<ElementId>& active) {
        std::vector<ElementId> fresh;
        for (ElementId e : active) {
            const Sampled& s = sampled_[e];
            // An even share for every element of the first mesh: area x error^2 <= mean area x tolerance^2.
            const double share = options_.tolerance * std::sqrt(mean_area_ / out_.tree.area(e));
            const double doubt = 2 * std::sqrt(1.25 * s.noise_squared);
            if (s.departure <= share + doubt) continue;
            for (ElementId child : refine_element(out_.tree, e)) fresh.push_back(child);
        }
        return fresh;
    }

    void finish(LocalPassReport& report) {
        out_.first_value.resize(out_.tree.size());
        double noise = 0, interpolation = 0;
        report.leaves.resize(out_.tree.size());
        for (ElementId e : out_.tree.leaves()) {
            const Sampled& s = sampled_[e];
            out_.first_value[e] = static_cast<std::uint32_t>(out_.values.size());
            for (int i = 0; i < out_.tree.patch(e).corner_count(); ++i) {
                out_.add_value(s.corners[static_cast<std::size_t>(i)]);
            }
            report.leaves[e] = {std::sqrt(s.departure * s.departure + s.noise_squared), s.node_rays};
            noise += out_.tree.area(e) * s.noise_squared;
            interpolation += out_.tree.area(e) * std::max(0.0, s.departure * s.departure - 1.25 * s.noise_squared);
        }
        report.noise = std::sqrt(noise / stage_.area);
        report.interpolation = std::sqrt(interpolation / stage_.area);
    }

    const Stage& stage_;
    const RadiosityAt& b_;
    const LocalPassOptions& options_;
    ElementFunction out_;
    Field<ElementId, Sampled> sampled_;
    double mean_area_ = 0;
};

}  // namespace

ElementFunction gather_indirect_light(const Stage& stage, const RadiosityAt& b, const LocalPassOptions& options,
                                      LocalPassReport& report, Progress& progress, const StopRequest& stop) {
    return LocalPass(stage, b, options).run(report, progress, stop);
}

}  // namespace exitance
