#include "exitance/lab/local_passes/local_pass_study.hpp"

#include <fmt/format.h>

#include <ctime>
#include <optional>
#include <utility>

#include "exitance/base/random.hpp"
#include "exitance/lab/local_passes/local_passes.hpp"
#include "exitance/lab/local_passes/solve_by_lines.hpp"
#include "exitance/reference/compare.hpp"
#include "exitance/reference/path_reference.hpp"

namespace exitance {
namespace {

/// Points that are uniform over all reflecting surfaces, with their true light.
class Truth {
  public:
    Truth(const Stage& stage, const LocalPassStudyOptions& options, Progress& progress, const StopRequest& stop)
        : scene_(stage.scene) {
        std::vector<const Piece*> pieces;
        double total = 0, passed = 0;
        for (const Piece& piece : stage.pieces)
            if (max(scene_.material(piece.region).reflectance) > 0 && !stage.is_unlit(piece.region))
                pieces.push_back(&piece), total += piece.patch.area();
        const ScrambledSobol sobol(hash(options.seed, static_cast<std::uint64_t>(Stream::reference)));
        std::size_t p = 0;
        for (std::uint32_t i = 0; i < options.points && !pieces.empty(); ++i) {
            const double at = total * (i + sobol(i, 2)) / static_cast<double>(options.points);
            while (p + 1 < pieces.size() && passed + pieces[p]->patch.area() < at) passed += pieces[p++]->patch.area();
            const Patch& patch = pieces[p]->patch;
            const RegionId region = pieces[p]->region;
            points_.push_back(
                {patch.at(uniform_in_shape(patch.shape, sobol(i, 0), sobol(i, 1))), scene_.regions()[region].plane.n});
            regions_.push_back(region);
            surfaces_.push_back(scene_.regions()[region].surfaces.front());
        }
        for (const ReferenceLight& l :
             reference_light(scene_, points_, options.paths, options.seed + 1, progress, stop)) {
            // No light reaches a point that another surface covers.
            const std::size_t i = truth_.size();
            const bool covered = stage.occluders.is_covered(points_[i].x, points_[i].n, regions_[i]);
            truth_.push_back(covered ? Spectrum() : l.irradiance);
            noise_.push_back(covered ? Spectrum() : l.standard_error);
        }
    }

    ErrorMeasure error_of(const SixNodeMesh& mesh) const {
        const SixNodeLocator locator(mesh, scene_);
        std::vector<Spectrum> found;
        for (std::size_t i = 0; i < points_.size(); ++i) found.push_back(locator.at(regions_[i], points_[i].x));
        return measure_error(
            {.irradiance = found, .reference = truth_, .standard_errors = noise_, .surfaces = surfaces_}, scene_);
    }

  private:
    const Scene& scene_;
    std::vector<ProbePoint> points_;
    std::vector<RegionId> regions_;
    std::vector<SurfaceId> surfaces_;
    std::vector<Spectrum> truth_, noise_;
};

std::optional<Error> refusal(const Scene& scene) {
    if (!scene.has_light_apart() && scene.panes().empty() && !scene.has_directed_emission()) return {};
    return Error{ErrorCode::bad_input, "has lights without extent, or that are not diffuse", scene.file(),
                 "links between diffuse polygons do not carry these"};
}

/// Processor time of all threads since construction, s; other programs do not affect it.
class ProcessorTime {
  public:
    double restart() {
        const std::clock_t before = std::exchange(start_, std::clock());
        return static_cast<double>(start_ - before) / CLOCKS_PER_SEC;
    }

  private:
    std::clock_t start_ = std::clock();
};

Error stopped() {
    return Error{ErrorCode::failure, "was stopped", "", ""};
}

}  // namespace

Result<std::vector<LocalPassRow>> run_local_pass_study(const Scene& scene, const LocalPassStudyOptions& options,
                                                       Progress& progress, const StopRequest& stop) {
    if (std::optional<Error> error = refusal(scene)) return *error;
    const Stage stage(scene);
    progress.phase("reference");
    const Truth truth(stage, options, progress, stop);
    std::vector<LocalPassRow> rows;
    for (const auto& [name, accuracy] : options.accuracies) {
        SolveOptions asked;
        asked.seed = options.seed;
        ProcessorTime watch;
        LineHierarchy hierarchy(stage, line_options(asked, accuracy));
        const bool whole = hierarchy.solve(progress, stop);
        const double global = watch.restart();
        for (const LocalPassRule rule : options.rules) {
            if (!whole || stop.requested()) return stopped();
            watch.restart();
            LocalPassWork work;
            const SixNodeMesh mesh = run_local_pass(hierarchy, rule, work, stop);
            const double local = watch.restart();
            const ErrorMeasure error = truth.error_of(mesh);
            rows.push_back({.accuracy = name,
                            .rule = std::string(name_in(local_pass_names, rule)),
                            .threshold = hierarchy.options().threshold,
                            .links = hierarchy.links().size(),
                            .leaves = hierarchy.leaf_count(),
                            .triangles = mesh.size(),
                            .error = error.relative_rms_error,
                            .noise = error.reference_noise,
                            .global_seconds = global,
                            .local_seconds = local,
                            .form_factors = work.form_factors,
                            .rays = work.rays});
            progress.note(
                fmt::format("{} {}: error {:.2f}%, {:.2f} s", name, rows.back().rule, 100 * rows.back().error, local));
        }
    }
    return rows;
}

std::string local_pass_csv(const std::string& scene, const std::vector<LocalPassRow>& rows) {
    std::string out =
        "scene,accuracy,threshold,links,leaves,triangles,rule,error,noise,global_seconds,local_seconds,form_factors,"
        "rays\n";
    for (const LocalPassRow& r : rows)
        out += fmt::format("{},{},{:.3g},{},{},{},{},{:.5f},{:.5f},{:.3f},{:.3f},{},{}\n", scene, r.accuracy,
                           r.threshold, r.links, r.leaves, r.triangles, r.rule, r.error, r.noise, r.global_seconds,
                           r.local_seconds, r.form_factors, r.rays);
    return out;
}

Result<std::vector<LinkThresholdRow>> run_link_threshold_study(const Scene& scene, const std::vector<double>& darks,
                                                               double accuracy, const LocalPassStudyOptions& options,
                                                               Progress& progress, const StopRequest& stop) {
    if (std::optional<Error> error = refusal(scene)) return *error;
    const Stage stage(scene);
    progress.phase("reference");
    const Truth truth(stage, options, progress, stop);
    std::vector<LinkThresholdRow> rows;
    for (const double dark : darks) {
        SolveOptions asked;
        asked.seed = options.seed;
        ProcessorTime watch;
        LineHierarchyOptions knobs = line_options(asked, accuracy);
        knobs.layers = true, knobs.dark = dark;
        LineHierarchy hierarchy(stage, knobs);
        if (!hierarchy.solve(progress, stop)) return stopped();
        LocalPassWork work;
        const SixNodeMesh mesh = run_local_pass(hierarchy, LocalPassRule::e, work, stop);
        const double seconds = watch.restart();
        const ErrorMeasure error = truth.error_of(mesh);
        rows.push_back({dark, hierarchy.links().size(), hierarchy.leaf_count(), error.relative_rms_error,
                        error.reference_noise, seconds});
    }
    return rows;
}

std::string link_threshold_csv(const std::string& scene, const std::vector<LinkThresholdRow>& rows) {
    std::string out = "scene,dark,links,leaves,error,noise,seconds\n";
    for (const LinkThresholdRow& r : rows)
        out += fmt::format("{},{:.3g},{},{},{:.5f},{:.5f},{:.3f}\n", scene, r.dark, r.links, r.leaves, r.error, r.noise,
                           r.seconds);
    return out;
}

}  // namespace exitance
