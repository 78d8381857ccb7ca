#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

struct LocalPassStudyOptions {
    /// Accuracies of the global pass: relative errors from which its threshold and minimum area are derived.
    std::vector<std::pair<std::string, double>> accuracies{{"low", 0.16}, {"medium", 0.08}, {"high", 0.04}};
    std::vector<LocalPassRule> rules{LocalPassRule::a, LocalPassRule::b, LocalPassRule::c, LocalPassRule::d,
                                     LocalPassRule::e};
    /// Points at which paths compute the true light, and the number of paths per point.
    std::size_t points = 400, paths = 1024;
    std::uint64_t seed = 1;
};

/// One global pass followed by one local pass.
struct LocalPassRow {
    std::string accuracy, rule;
    double threshold = 0;  ///< Threshold of links, as a share of the emitted flux.
    std::size_t links = 0, leaves = 0, triangles = 0;
    /// Relative RMS error of radiosity against the paths, without their noise; and that noise.
    double error = 0, noise = 0;
    double global_seconds = 0, local_seconds = 0;  ///< Processor time of all threads.
    std::size_t form_factors = 0, rays = 0;        ///< Work of the local pass.
};

/// Measures errors and times of the local passes a to e on global passes of several accuracies: the experiment of
/// [Lischinski93]. Returns rows by accuracy, then by rule. Error: failure, if the scene has light that links cannot
/// transport, or after a request to stop.
Result<std::vector<LocalPassRow>> run_local_pass_study(const Scene& scene, const LocalPassStudyOptions& options,
                                                       Progress& progress, const StopRequest& stop);
std::string local_pass_csv(const std::string& scene, const std::vector<LocalPassRow>& rows);

/// A row of the study of initial links.
struct LinkThresholdRow {
    double dark = 0;  ///< Nodes that reflect less have no links, as a share of the mean reflected direct light.
    std::size_t links = 0, leaves = 0;
    double error = 0, noise = 0, seconds = 0;
};

/// Measures links, error and time for a separate layer of direct light plus hierarchical indirect light, depending on
/// the threshold of light below which nodes have no initial links.
Result<std::vector<LinkThresholdRow>> run_link_threshold_study(const Scene& scene, const std::vector<double>& darks,
                                                               double accuracy, const LocalPassStudyOptions& options,
                                                               Progress& progress, const StopRequest& stop);
std::string link_threshold_csv(const std::string& scene, const std::vector<LinkThresholdRow>& rows);

}  // namespace exitance
