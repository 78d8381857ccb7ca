// Sensitivity to each calibrated number: exitance-calibrate [NAME...] [--error E]. Solves generated scenes, which are
// not those of README or of the tests, with the number at half, at its value and at double. Prints work (rays plus 50
// times the leaf elements) and true error, each relative to those at its value.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "exitance/calibration/table.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/samples/generate.hpp"

namespace exitance {
namespace {

struct Case {
    const char* family;
    std::map<std::string, std::string> values;
    SolveOptions options;
};
/// Cases: sums over elements, rays, small objects; links with clusters, and links of third order without gather.
const std::vector<Case> cases{{"tube", {{"rho", "0.6"}, {"length", "4"}}, {}},
                              {"clutter", {{"n", "20"}}, {}},
                              {"complex", {{"m", "1"}}, {}},
                              {"complex", {{"m", "2"}}, {.method = Method::hierarchical, .clusters = true}},
                              {"tube",
                               {{"rho", "0.5"}, {"length", "3"}},
                               {.method = Method::wavelet, .basis = BasisKind::multiwavelet3, .smoothing = false}}};

struct Outcome {
    double work = 0, error = 0;
};

std::vector<Light> light_of(const Scene& scene, const SolveOptions& options, std::span<const ProbePoint> points,
                            double& work) {
    Progress progress;
    const Result<Solution> solution = solve_scene(scene, options, progress, StopRequest());
    if (!solution) std::exit(1);
    work =
        static_cast<double>(solution->statistics.rays) + 50 * static_cast<double>(solution->statistics.leaf_elements);
    return RadiosityFunction(*solution).at(points);
}

class Trial {
  public:
    Trial(const Case& c, double error)
        : scene_(std::move(*make_scene(std::move(*generate_scene(c.family, c.values))).scene)),
          points_(points_uniform_in_area(scene_, 400, 3)) {
        options_ = c.options, options_.error = error / 8;
        double work = 0;
        truth_ = light_of(scene_, options_, points_, work);
        options_.error = error;
        own_ = run();
    }

    Outcome run() const {
        Outcome out;
        const std::vector<Light> light = light_of(scene_, options_, points_, out.work);
        double square = 0, all = 0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            square += squared(light[i].radiosity - truth_[i].radiosity);
            all += mean(truth_[i].radiosity);
        }
        out.error = std::sqrt(square * static_cast<double>(light.size())) / all;
        return out;
    }
    const Outcome& own() const { return own_; }

  private:
    Scene scene_;
    std::vector<ProbePoint> points_;
    SolveOptions options_;
    std::vector<Light> truth_;
    Outcome own_;
};

}  // namespace
}  // namespace exitance

int main(int argc, char** argv) {
    using namespace exitance;
    std::vector<std::string> names;
    double error = 0.02;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--error" && i + 1 < argc)
            error = std::atof(argv[++i]);
        else if (find_calibrated(word))
            names.push_back(word);
        else
            return std::fprintf(stderr, "exitance-calibrate [NAME...] [--error E]: there is no %s\n", argv[i]), 2;
    }
    if (names.empty())
        for (const CalibratedNumber& row : calibration_table()) names.emplace_back(row.name);
    std::vector<Trial> trials;
    std::printf("%-30s %10s", "number", "value");
    for (const Case& c : cases) {
        trials.emplace_back(c, error);
        std::printf("  %7s half, double", c.family);
    }
    std::printf("   (work/error)\n");
    for (const std::string& name : names) {
        const CalibratedNumber& row = *find_calibrated(name);
        const double own = *row.stored;
        std::printf("%-30s %10g", name.c_str(), own);
        bool insensitive = true, is_read = false;
        for (const Trial& trial : trials) {
            for (const double factor : {0.5, 2.0}) {
                const TriedNumber tried(row, factor * own);
                const Outcome now = trial.run();
                const double work = now.work / trial.own().work, off = now.error / trial.own().error;
                is_read |= work != 1 || off != 1;
                insensitive &= std::abs(std::log(work)) < 0.05 && std::abs(std::log(off)) < 0.05;
                std::printf(" %5.2f/%-5.2f", work, off);
            }
        }
        std::printf("%s\n", !is_read ? "  moves nothing" : insensitive ? "  insensitive" : "");
        std::fflush(stdout);
    }
}
