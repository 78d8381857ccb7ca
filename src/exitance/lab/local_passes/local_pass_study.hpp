#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

struct LocalPassStudyOptions {
    /// Accuracies of the global pass, as relative errors that its threshold and least area are derived from.
    std::vector<std::pair<std::string, double>> accuracies{{"low", 0.16}, {"medium", 0.08}, {"high", 0.04}};
    std::vector<LocalPassRule> rules{LocalPassRule::a, LocalPassRule::b, LocalPassRule::c, LocalPassRule::d,
                                     LocalPassRule::e};
    std::size_t points = 400, paths = 1024;  ///< At which paths tell the true light, and how many of them.
    std::uint64_t seed = 1;
};

/// One global pass followed by one local pass.
struct LocalPassRow {
    std::string accuracy, rule;
    double threshold = 0;  ///< Of links, as a share of the emitted flux.
    std::size_t links = 0, leaves = 0, triangles = 0;
    double error = 0, noise = 0;  ///< Relative RMS of radiosity against the paths, their noise taken out; and that.
    double global_seconds = 0, local_seconds = 0;  ///< Processor time of all threads.
    std::size_t form_factors = 0, rays = 0;        ///< Of the local pass.
};

/// Errors and times of local passes a to e on global passes of several accuracies: the experiment of [Lischinski93].
/// Rows by accuracy, then by rule. Error: failure, where the scene has light that links cannot carry, or a stop was
/// asked for.
Result<std::vector<LocalPassRow>> run_local_pass_study(const Scene& scene, const LocalPassStudyOptions& options,
                                                       Progress& progress, const StopRequest& stop);
std::string local_pass_csv(const std::string& scene, const std::vector<LocalPassRow>& rows);

/// A row of the study of initial links.
struct LinkThresholdRow {
    double dark = 0;  ///< Nodes that reflect less have no links, as a share of mean reflected direct light.
    std::size_t links = 0, leaves = 0;
    double error = 0, noise = 0, seconds = 0;
};

/// Direct light in a layer and hierarchical indirect light, with initial links only where light is above a threshold:
/// links, error and time against it.
Result<std::vector<LinkThresholdRow>> run_link_threshold_study(const Scene& scene, const std::vector<double>& darks,
                                                               double accuracy, const LocalPassStudyOptions& options,
                                                               Progress& progress, const StopRequest& stop);
std::string link_threshold_csv(const std::string& scene, const std::vector<LinkThresholdRow>& rows);

}  // namespace exitance
