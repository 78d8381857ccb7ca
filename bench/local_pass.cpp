// Local passes a to e on global passes of three accuracies, and links against the threshold of initial links, as CSV:
// exitance-local-pass SCENE [--quick] [--links]
#include <cstdio>
#include <string>

#include "exitance/experiments/local_pass/local_pass_study.hpp"
#include "exitance/io/scenes/scene_file.hpp"

int main(int argc, char** argv) {
    using namespace exitance;
    std::string file;
    bool links = false;
    LocalPassStudyOptions options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--quick")
            options.points = 200, options.paths = 256, options.accuracies.pop_back();
        else if (word == "--links")
            links = true;
        else
            file = word;
    }
    if (file.empty()) {
        std::fprintf(stderr, "exitance-local-pass SCENE [--quick] [--links]\n");
        return 2;
    }
    const CheckedScene checked = load_scene(file);
    if (!checked.scene) {
        std::fprintf(stderr, "error: %s\n", checked.scene.error().message.c_str());
        return 3;
    }
    Progress progress;
    const StopRequest stop;
    std::string csv;
    if (links) {
        const auto rows =
            run_link_threshold_study(*checked.scene, {0, 0.01, 0.03, 0.1, 0.3, 1}, 0.08, options, progress, stop);
        if (rows) csv = link_threshold_csv(file, *rows);
    } else {
        const auto rows = run_local_pass_study(*checked.scene, options, progress, stop);
        if (rows) csv = local_pass_csv(file, *rows);
    }
    if (csv.empty()) {
        std::fprintf(stderr, "error: %s: has light that links between diffuse polygons cannot carry\n", file.c_str());
        return 1;
    }
    std::fputs(csv.c_str(), stdout);
    return 0;
}
