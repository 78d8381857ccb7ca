#include "exitance/methods/solve_scene.hpp"

#include <fmt/format.h>

#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/reconstruct/certificate.hpp"
#include "exitance/reconstruct/interpolant.hpp"
#include "exitance/reconstruct/local_pass.hpp"

namespace exitance {
namespace {

const MethodEntry& find_method(Method wanted) {
    const Method id = wanted == Method::automatic ? Method::matrix : wanted;
    const auto table = method_table();
    return *std::find_if(table.begin(), table.end(), [&](const MethodEntry& m) { return m.id == id; });
}

/// An indirect light of nothing: every piece one element, dark.
ElementFunction dark(const Stage& stage) {
    ElementFunction out;
    for (const auto& [region, patch] : stage.pieces) out.tree.add_root(region, patch);
    out.first_value.resize(out.tree.size(), 0);
    out.values.assign(4, {});
    return out;
}

/// Light that a method carried through its elements, as it stands there: constant on every leaf.
ElementFunction constant_on_leaves(const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        out.first_value[light.numbering.leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < 4; ++corner) out.add_value(light.indirect[i]);
    }
    return out;
}

/// What rays read in the local pass: on every leaf the direct light that was projected there, and the indirect light that
/// the method found, times the reflectance.
ElementFunction reflected_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Spectrum& rho = scene.material(out.tree.region(e)).reflectance;
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (std::size_t corner = 0; corner < 4; ++corner)
            out.add_value(rho * ((light.on_projection ? direct.corners[e][corner] : light.direct[i]) + light.indirect[i]));
    }
    return out;
}

class Solver {
  public:
    Solver(const Scene& scene, const SolveOptions& options, Progress& progress, const StopRequest& stop)
        : options_(options), progress_(progress), stop_(stop), solution_{.scene = scene}, stage_(scene) {
        solution_.bounces = options.bounces;
        statistics().method = name_in(method_names, find_method(options.method).id);
        statistics().basis = find_method(options.method).basis;
        statistics().threads = threads();
        statistics().schedule = "stealing";
        statistics().surfaces = scene.surfaces().size();
        statistics().converged = true;
        solution_.indirect = dark(stage_);
    }

    Solution run() {
        if (options_.bounces != 0 && stage_.has_indirect_light()) solve_indirect_light();
        make_output_mesh();
        return std::move(solution_);
    }

  private:
    SolveStatistics& statistics() { return solution_.statistics; }

    /// Method, local pass, certificate, until the certificate is content.
    void solve_indirect_light() {
        constexpr int most_attempts = 5;
        const std::optional<double> demand = options_.error_demand();
        Knobs knobs = knobs_for_error(options_.error_target(), stage_.pieces, options_);
        for (int attempt = 1;; ++attempt) {
            solve_once(knobs);
            if (stop_.requested()) {
                statistics().stopped_by = stop_.interrupted() ? "interrupt" : "time limit";
                statistics().converged = false;
                return;
            }
            if (!demand || certificate_.estimate <= *demand) return;
            if (attempt == most_attempts) {
                statistics().stopped_by = "iterations";
                statistics().converged = false;
                return;
            }
            progress_.advance(0, fmt::format("error {:.2f}%, {:.2f}% asked for: once more, finer",
                                             100 * certificate_.estimate, 100 * *demand));
            knobs = tightened(knobs, std::clamp(0.8 * *demand / certificate_.estimate, 0.2, 0.75), options_);
        }
    }

    void solve_once(const Knobs& knobs) {
        Stopwatch watch;
        progress_.phase("direct light");
        direct_ = project_direct_light(stage_, {.mesh = knobs.solve_mesh, .tolerance = knobs.direct_tolerance}, stop_);
        statistics().seconds["mesh"] += watch.restart();
        light_ = find_method(options_.method).solve({stage_, options_, knobs, direct_, progress_, stop_});
        statistics().seconds["solve"] += watch.restart();

        const ElementLocator direct_locator(direct_.tree, stage_.scene.regions().size());
        const ElementFunction source = reflected_light(stage_.scene, direct_, light_);
        const ElementLocator locator(source.tree, stage_.scene.regions().size());
        const RadiosityAt reflected = [&](RegionId region, const Point& y) {
            return source.at(locator.find(region, y));
        };
        LocalPassReport gathered;
        solution_.direct_in_elements = light_.holds_direct;
        if (light_.holds_direct) {
            solution_.indirect = constant_on_leaves(light_);
        } else {
            progress_.phase("gather");
            solution_.indirect = gather_indirect_light(
                stage_, reflected,
                {.mesh = knobs.gather_mesh, .rays = knobs.gather_rays,
                 .noise = knobs.gather_noise * light_.mean_reflected(),
                 .tolerance = knobs.gather_tolerance * light_.mean_reflected(), .seed = options_.seed},
                gathered, stop_);
        }
        statistics().seconds["reconstruct"] += watch.restart();

        progress_.phase("certify");
        const ElementLocator indirect(solution_.indirect.tree, stage_.scene.regions().size());
        const RadiosityAt delivered = [&](RegionId region, const Point& y) {
            return stage_.scene.material(region).reflectance *
                   (direct_.at(direct_locator.find(region, y)) + solution_.indirect.at(indirect.find(region, y)));
        };
        certificate_ = certify(stage_, light_, solution_.indirect, delivered,
                               {.error = options_.error_target(), .seed = options_.seed,
                                .direct_in_elements = light_.holds_direct,
                                .leaves = light_.holds_direct ? nullptr : &gathered.leaves});
        statistics().seconds["certify"] += watch.restart();
        statistics().iterations += light_.report.iterations;
        statistics().residual = light_.report.residual;
        statistics().rays += light_.rays + gathered.rays + certificate_.rays;
        statistics().links = light_.links;
        statistics().link_memory_bytes = light_.link_memory_bytes;
        statistics().elements = light_.tree.size() + solution_.indirect.tree.size();
        statistics().leaf_elements = light_.numbering.leaves.size() + solution_.indirect.tree.leaves().size();
        statistics().relative_error_estimate = certificate_.estimate;
        statistics().relative_error_bound = certificate_.bound;
        const double scale = certificate_.mean_reflected > 0 ? 100 / certificate_.mean_reflected : 0;
        progress_.note(fmt::format(
            "{} elements solved on, {} gathered on; mean reflected radiosity {:.4g} W/m^2; error estimate {:.3f}%, bound "
            "{:.3f}%, residual {:.3f}%, error constant {:.2f}; rays' noise {:.3f}%, interpolation {:.3f}%; rays {} + {} + {}",
            light_.numbering.leaves.size(), solution_.indirect.tree.leaves().size(), certificate_.mean_reflected,
            100 * certificate_.estimate, 100 * certificate_.bound, 100 * certificate_.residual, certificate_.constant,
            scale * gathered.noise, scale * gathered.interpolation, light_.rays, gathered.rays, certificate_.rays));
    }

    void make_output_mesh() {
        Stopwatch watch;
        progress_.phase("reconstruct");
        double scale = certificate_.mean_reflected;
        if (scale <= 0) scale = mean_direct_light();
        InterpolantReport report;
        solution_.interpolant = make_interpolant(
            stage_, solution_.indirect,
            {.edge = edge_for_elements(stage_.pieces, static_cast<std::size_t>(4 / options_.error_target())),
             .tolerance = 2.5 * options_.error_target() * scale,
             .add_direct = !solution_.direct_in_elements},
            report, stop_);
        const double own = scale > 0 ? report.error / scale : 0;
        statistics().relative_error_estimate_interpolant = std::hypot(own, statistics().relative_error_estimate);
        statistics().seconds["reconstruct"] += watch.seconds();
        progress_.note(fmt::format("{} elements to export, {:.3f}% from the function by themselves",
                                   solution_.interpolant.tree.leaves().size(), 100 * own));
    }

    /// Mean of E where nothing reflects: then E itself is what errors are relative to.
    double mean_direct_light() const {
        double flux = 0;
        DirectLight::Workspace workspace;
        for (const auto& [region, patch] : stage_.pieces)
            flux += patch.area() * mean(stage_.direct.irradiance(patch.centre(), stage_.scene.regions()[region].plane.n,
                                                                 region, workspace));
        return flux / stage_.area;
    }

    const SolveOptions& options_;
    Progress& progress_;
    const StopRequest& stop_;
    Solution solution_;
    Stage stage_;
    DirectProjection direct_;
    GlobalLight light_;
    Certificate certificate_;
};

}  // namespace

Result<Solution> solve_scene(const Scene& scene, const SolveOptions& options, Progress& progress,
                             const StopRequest& stop) {
    if (options.threads > 0) set_threads(options.threads);
    Stopwatch watch;
    Solution solution = Solver(scene, options, progress, stop).run();
    solution.statistics.seconds["total"] = watch.seconds();
    solution.statistics.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance
