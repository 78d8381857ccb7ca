#include "exitance/methods/solve_scene.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/core/memory.hpp"
#include "exitance/core/parallel.hpp"
#include "exitance/methods/memory_plan.hpp"
#include "exitance/methods/methods.hpp"
#include "exitance/reconstruct/certificate.hpp"
#include "exitance/reconstruct/energy.hpp"
#include "exitance/reconstruct/interpolant.hpp"
#include "exitance/reconstruct/local_pass.hpp"
#include "exitance/solve/direct_share.hpp"

namespace exitance {
namespace {

/// What `auto` stands for. Reflections are counted by `matrix` alone, whose iterations are reflections.
const MethodEntry& find_method(const SolveOptions& options) {
    const bool counts_bounces = options.bounces > 0;
    const Method id = options.method == Method::automatic || counts_bounces ? Method::matrix : options.method;
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

/// Light as a method left it on its elements: constant on every leaf.
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

/// What rays read in the local pass, b + c M: on every leaf the direct light that was projected there, and the indirect
/// light that the method found, times the reflectance, and the share c of what it emits. Where the method's own
/// elements agree with that share, E_dir + E_ind is alike all over a leaf but for (1 - c) E_dir.
ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Material& material = scene.material(out.tree.region(e));
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        const Spectrum mean = light.direct_share * light.direct[i];
        for (std::size_t k = 0; k < 4; ++k) {
            const Spectrum& E_dir = light.on_projection ? direct.fit[e].corners[k] : light.direct[i];
            const Spectrum& E_ind = light.indirect_corners.empty() ? light.indirect[i] : light.indirect_corners[i][k];
            out.add_value(material.reflectance * (E_dir - light.direct_share * E_dir + mean + E_ind) +
                          c * material.exitance);
        }
    }
    return out;
}

/// RMS over the surfaces of the standard error of rho E_ind, where a method is a random one, W/m^2.
double rms_standard_error(const Scene& scene, const GlobalLight& light) {
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < light.standard_error.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Spectrum& rho = scene.material(light.tree.region(e)).reflectance;
        sum += light.tree.area(e) * squared(rho * light.standard_error[i]) / static_cast<double>(bands);
        area += light.tree.area(e);
    }
    return area > 0 ? std::sqrt(sum / area) : 0;
}

class Solver {
  public:
    Solver(const Scene& scene, const SolveOptions& options, Progress& progress, const StopRequest& stop)
        : options_(options), progress_(progress), stop_(stop), solution_{.scene = scene}, stage_(scene) {
        const MethodEntry& method = find_method(options);
        if (options.method != Method::automatic && options.method != method.id)
            warn(fmt::format("--bounces is counted by the method matrix, which solves in place of {}",
                             name_in(method_names, options.method)));
        solution_.bounces = options.bounces;
        statistics().method = name_in(method_names, method.id);
        const bool linear = method.id == Method::matrix && options.basis == BasisKind::linear && options.bounces < 0;
        statistics().basis = linear ? "linear" : method.basis;
        statistics().threads = threads();
        statistics().schedule = "stealing";
        statistics().surfaces = scene.surfaces().size();
        statistics().converged = true;
        solution_.indirect = dark(stage_);
        // Under a near deadline a coarse answer comes first, so that there is one whenever time runs out.
        constexpr double coarse = 0.08;
        constexpr double near = 30;  // seconds
        const bool deadline = stop.seconds_left() < near;
        knobs_ = knobs_for_error(deadline ? std::max(coarse, options.error_target()) : options.error_target(),
                                 stage_.pieces, options);
    }

    Result<Solution> run() {
        if (options_.memory_limit_bytes) {
            const Result<bool> fits = fit_into_memory(knobs_, stage_.pieces, options_);
            if (!fits) return fits.error();
            if (!*fits) stop_early("memory limit");
        }
        if (options_.bounces != 0 && stage_.has_indirect_light())
            solve_indirect_light();
        else
            project_direct();
        make_output_mesh();
        return std::move(solution_);
    }

  private:
    SolveStatistics& statistics() { return solution_.statistics; }

    void warn(std::string message) {
        progress_.warn(message);
        statistics().warnings.push_back(std::move(message));
    }

    void stop_early(const char* why) {
        statistics().stopped_by = why;
        statistics().converged = false;
    }

    /// Method, local pass, certificate, until the certificate is content.
    void solve_indirect_light() {
        constexpr int most_attempts = 9;
        const std::optional<double> demand = options_.error_demand();
        for (int attempt = 1;; ++attempt) {
            const Stopwatch watch;
            solve_once();
            if (stop_.requested()) return stop_early(stop_.interrupted() ? "interrupt" : "time limit");
            // The estimate is itself uncertain by a fifth: it has to be below the demand by as much.
            constexpr double margin = 0.82;
            if (!demand || certificate_.estimate <= margin * *demand) {
                if (statistics().stopped_by.empty() || demand)
                    statistics().converged = true, statistics().stopped_by.clear();
                return;
            }
            if (statistics().stopped_by == "memory limit") return;
            if (attempt == most_attempts) return stop_early("iterations");
            const double factor = std::clamp(0.7 * *demand / certificate_.estimate, 0.2, 0.6);
            // A finer attempt takes about factor^-2 as long; one that cannot end in time would only be thrown away.
            if (stop_.seconds_left() < watch.seconds() / (factor * factor)) return stop_early("time limit");
            progress_.note(fmt::format("error {:.2f}%, {:.2f}% asked for: once more, finer",
                                       100 * certificate_.estimate, 100 * *demand));
            knobs_ = tightened(knobs_, factor, options_);
            if (options_.memory_limit_bytes) {
                const Result<bool> fits = fit_into_memory(knobs_, stage_.pieces, options_);
                if (!fits || !*fits) return stop_early("memory limit");
            }
        }
    }

    void project_direct() {
        progress_.phase("direct light");
        const Stopwatch watch;
        DirectProjection fresh = project_direct_light(stage_,
                                                      {.mesh = knobs_.solve_mesh,
                                                       .tolerance = knobs_.direct_tolerance,
                                                       .least_area = options_.min_area,
                                                       .may_give_up = direct_.tree.size() > 0},
                                                      stop_);
        if (fresh.tree.size() > 0) direct_ = std::move(fresh);
        statistics().seconds["mesh"] += watch.seconds();
    }

    void solve_once() {
        project_direct();
        if (stop_.requested() && certificate_.points > 0) return;
        Stopwatch watch;
        GlobalLight light = find_method(options_).solve({stage_, options_, knobs_, direct_, progress_, stop_});
        statistics().seconds["solve"] += watch.restart();
        LocalPassReport gathered;
        const bool whole = !light.holds_direct && options_.bounces < 0;
        const Spectrum share = whole ? direct_share(light) : Spectrum();
        ElementFunction indirect = light.holds_direct ? constant_on_leaves(light) : gather(light, share, gathered);
        statistics().seconds["reconstruct"] += watch.restart();
        if (stop_.requested()) {
            // Half a local pass is worth less than the last whole one, or than what the method has found.
            if (certificate_.points > 0) return;
            solution_.indirect = constant_on_leaves(light);
            solution_.direct_in_elements = light.holds_direct;
            constexpr double roughly = 0.1;
            certificate_ = certify_solution(light, nullptr, roughly);
            record(light, gathered);
            return;
        }
        solution_.indirect = std::move(indirect);
        solution_.direct_share = share;
        solution_.direct_in_elements = light.holds_direct;
        progress_.phase("certify");
        certificate_ =
            certify_solution(light, light.holds_direct ? nullptr : &gathered.leaves, options_.error_target());
        statistics().seconds["certify"] += watch.restart();
        record(light, gathered);
    }

    Spectrum direct_share(const GlobalLight& light) const {
        const ElementLocator locator(light.tree, stage_.scene.regions().size());
        return find_direct_share(stage_, light, locator, options_.seed);
    }

    ElementFunction gather(const GlobalLight& light, const Spectrum& share, LocalPassReport& report) {
        progress_.phase("gather");
        const ElementFunction source = gathered_light(stage_.scene, direct_, light, share);
        const ElementLocator locator(source.tree, stage_.scene.regions().size());
        const RadiosityAt gathered = [&](RegionId region, const Point& y) {
            return source.at(locator.find(region, y));
        };
        const double scale = light.mean_reflected();
        return gather_indirect_light(stage_, gathered,
                                     {.mesh = knobs_.gather_mesh,
                                      .rays = knobs_.gather_rays,
                                      .noise = knobs_.gather_noise * scale,
                                      .tolerance = knobs_.gather_tolerance * scale,
                                      .seed = options_.seed},
                                     report, progress_, stop_);
    }

    /// `leaves`: what the local pass knows, or null; `error`: what is to be resolved.
    Certificate certify_solution(const GlobalLight& light, const Field<ElementId, LocalPassReport::Leaf>* leaves,
                                 double error) {
        const ElementLocator direct_locator(direct_.tree, stage_.scene.regions().size());
        const ElementLocator indirect(solution_.indirect.tree, stage_.scene.regions().size());
        const ElementLocator coarse(light.tree, stage_.scene.regions().size());
        const RadiosityAt delivered = [&](RegionId region, const Point& y) {
            // Where reflections are counted, the light to be gathered is one reflection older than what is delivered.
            Spectrum E = options_.bounces > 0 ? light.indirect[light.numbering.number[coarse.find(region, y).element]]
                                              : solution_.indirect.at(indirect.find(region, y));
            const Spectrum& c = solution_.direct_share;
            if (!light.holds_direct) E += (Spectrum(1.0) - c) * direct_.at(direct_locator.find(region, y));
            return stage_.scene.material(region).reflectance * E + c * stage_.scene.material(region).exitance;
        };
        return certify(
            stage_, light, solution_.indirect, delivered,
            {.error = error, .seed = options_.seed, .direct_in_elements = light.holds_direct, .leaves = leaves});
    }

    void record(const GlobalLight& light, const LocalPassReport& gathered) {
        SolveStatistics& s = statistics();
        s.iterations += light.report.iterations;
        s.residual = light.report.residual;
        s.rays += light.rays + gathered.rays + certificate_.rays;
        s.form_factors += light.form_factors;
        s.links = light.links;
        s.link_memory_bytes = light.link_memory_bytes;
        s.elements = light.tree.size() + solution_.indirect.tree.size();
        s.leaf_elements = light.numbering.leaves.size() + solution_.indirect.tree.leaves().size();
        s.relative_error_estimate = certificate_.estimate;
        s.relative_error_bound = certificate_.bound;
        const double scale = certificate_.mean_reflected > 0 ? 100 / certificate_.mean_reflected : 0;
        if (!light.standard_error.empty())
            progress_.note(
                fmt::format("standard error of the elements' indirect light {:.2f}% of the mean reflected light",
                            scale * rms_standard_error(stage_.scene, light)));
        progress_.note(fmt::format(
            "{} elements solved on, {} gathered on; mean reflected radiosity {:.4g} W/m^2; error estimate {:.3f}%, "
            "bound "
            "{:.3f}%, residual {:.3f}%, error constant {:.2f}; rays' noise {:.3f}%, interpolation {:.3f}%; rays {} + "
            "{} + {}",
            light.numbering.leaves.size(), solution_.indirect.tree.leaves().size(), certificate_.mean_reflected,
            100 * certificate_.estimate, 100 * certificate_.bound, 100 * certificate_.residual, certificate_.constant,
            scale * gathered.noise, scale * gathered.interpolation, light.rays, gathered.rays, certificate_.rays));
    }

    void make_output_mesh() {
        const Stopwatch watch;
        progress_.phase("reconstruct");
        if (solution_.direct_in_elements) {
            solution_.interpolant = solution_.indirect;
            statistics().relative_error_estimate_interpolant = statistics().relative_error_estimate;
        } else {
            // Where nothing reflects, E itself is what errors are relative to.
            const double scale =
                certificate_.mean_reflected > 0 ? certificate_.mean_reflected : mean_direct_light(stage_, direct_);
            InterpolantReport report;
            solution_.interpolant =
                make_interpolant(stage_, direct_, solution_.indirect, solution_.direct_share,
                                 {.tolerance = 2.5 * options_.error_target() * scale}, report, stop_);
            const double own = scale > 0 ? report.error / scale : 0;
            statistics().relative_error_estimate_interpolant = std::hypot(own, statistics().relative_error_estimate);
            progress_.note(fmt::format("{} elements to export, {:.3f}% from the function by themselves",
                                       solution_.interpolant.tree.leaves().size(), 100 * own));
        }
        statistics().energy = energy_balance(solution_, direct_);
        statistics().seconds["reconstruct"] += watch.seconds();
    }

    const SolveOptions& options_;
    Progress& progress_;
    const StopRequest& stop_;
    Solution solution_;
    Stage stage_;
    Knobs knobs_;
    DirectProjection direct_;
    Certificate certificate_;
};

}  // namespace

Result<Solution> solve_scene(const Scene& scene, const SolveOptions& options, Progress& progress,
                             const StopRequest& stop) {
    if (options.threads > 0) set_threads(options.threads);
    const Stopwatch watch;
    Result<Solution> solution = Solver(scene, options, progress, stop).run();
    if (!solution) return solution;
    solution->statistics.seconds["total"] = watch.seconds();
    solution->statistics.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance
