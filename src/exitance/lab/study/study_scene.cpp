#include "exitance/lab/study/study_scene.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "exitance/base/random.hpp"
#include "exitance/error/area_samples.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/reference_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/obj/obj_writer.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/samples/generate.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t points_seed = 7, paths_seed = 11;

Result<void> make_scene(const std::vector<std::string>& words, const std::string& path) {
    std::map<std::string, std::string> parameters;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const std::size_t equals = words[i].find('=');
        if (equals == std::string::npos || equals == 0)
            return Error{ErrorCode::usage, fmt::format("'{}' is not of the form name=value", words[i]), "generate", ""};
        parameters[words[i].substr(0, equals)] = words[i].substr(equals + 1);
    }
    const Result<SceneDescription> scene = generate_scene(words.empty() ? "" : words[0], parameters);
    if (!scene) return scene.error();
    return write_obj(*scene, path);
}

/// Input for computing a scene's reference.
struct ReferenceWork {
    const StudyOptions& options;
    const StudyReference& asked;
    const std::string& scene_path;
    const Scene& scene;
    std::string stem;  ///< Common path prefix of the files in which it is kept.
    Progress& progress;
    const StopRequest& stop;

    std::size_t points() const { return options.quick ? asked.quick_points : asked.points; }
    std::size_t paths() const { return options.quick ? asked.quick_paths : asked.paths; }
    const std::string& words() const { return options.quick ? asked.quick_options : asked.options; }
};

/// Returns light by paths; reads it from a file if it exists.
Result<ReferencePoints> path_reference(const ReferenceWork& work) {
    const std::string path = work.stem + "_paths.csv";
    if (fs::exists(path)) return load_reference_points(path);
    ReferencePoints out{points_uniform_in_area(work.scene, work.points(), points_seed), {}, {}};
    for (const ReferenceLight& light :
         reference_light(work.scene, out.points, work.paths(), paths_seed, work.progress, work.stop))
        out.irradiance.push_back(light.irradiance), out.standard_errors.push_back(light.standard_error);
    if (work.stop.requested()) return Error{ErrorCode::limit, "was stopped", "reference", ""};
    if (const Result<void> written = write_reference_points(path, out); !written) return written.error();
    return out;
}

/// Returns light by a careful solve at the same points, likewise.
Result<ReferencePoints> solved_reference(const ReferenceWork& work) {
    const std::string path = work.stem + "_solve.csv", solution_path = work.stem + ".h5";
    if (fs::exists(path)) return load_reference_points(path);
    std::vector<std::string> words{work.options.program, "solve", work.scene_path, "-o", solution_path, "-q"};
    for (const std::string& word : split_words(work.words())) words.push_back(word);
    const ProgramRun run = run_program(words, "", std::numeric_limits<double>::infinity(), work.stop);
    if (work.stop.requested()) return Error{ErrorCode::limit, "was stopped", "reference", ""};
    const Result<Solution> solution = load_solution(solution_path);
    if (!solution) return Error{ErrorCode::failure, "has no solution: " + run.err, "reference", ""};
    std::error_code ignored;
    fs::remove(solution_path, ignored);
    ReferencePoints out{points_uniform_in_area(work.scene, work.points(), points_seed), {}, {}};
    out.irradiance = irradiance_at(*solution, out.points);
    if (const Result<void> written = write_reference_points(path, out); !written) return written.error();
    return out;
}

Result<void> add_reference(StudyStage& stage, const ReferenceWork& work) {
    Result<ReferencePoints> traced = path_reference(work);
    if (!traced) return traced.error();
    if (work.words().empty()) {
        stage.reference = std::move(*traced);
        return {};
    }
    Result<ReferencePoints> solved = solved_reference(work);
    if (!solved) return solved.error();
    const Locator locator(work.scene);
    std::vector<SurfaceId> surfaces;
    for (const ProbePoint& point : traced->points) surfaces.push_back(locator.find(point.x, point.n));
    stage.check =
        measure_error({solved->irradiance, traced->irradiance, traced->standard_errors, surfaces}, work.scene);
    stage.reference = std::move(*solved);
    return {};
}

}  // namespace

std::uint64_t key_of(std::string_view text) {
    std::uint64_t key = text.size();
    for (const char c : text) key = hash(key, static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    return key;
}

Result<StudyStage> prepare_scene(const Study& study, const StudyScene& scene, double value, const StudyOptions& options,
                                 Progress& progress, const StopRequest& stop) {
    const fs::path folder = options.folder;
    const std::vector<std::pair<std::string, std::string>> values{{"value", fmt::format("{:g}", value)}};
    StudyStage stage;
    if (scene.file.empty()) {
        stage.words = filled_in(scene.generate, values);
        stage.path = (folder / "scenes" / fmt::format("{}_{:g}.obj", scene.name, value)).string();
        if (const Result<void> made = make_scene(split_words(stage.words), stage.path); !made) return made.error();
    } else {
        stage.words = filled_in(scene.file, values);
        stage.path = fs::absolute(fs::path(study.folder) / stage.words).lexically_normal().string();
    }
    const Result<std::string> content = read_whole_file(stage.path);
    if (!content) return content.error();
    const CheckedScene checked = load_scene({stage.path}, {});
    if (!checked.scene) return checked.scene.error();
    stage.polygons = checked.scene->surfaces().size();
    const StudyReference& asked = study.reference;
    stage.key = hash(key_of(*content), key_of(filled_in(asked.file, values)), asked.points, asked.paths,
                     options.quick ? asked.quick_points : 0, options.quick ? asked.quick_paths : 0,
                     key_of(options.quick ? asked.quick_options : asked.options));
    if (!asked.file.empty()) {
        Result<ReferencePoints> known =
            load_reference_points((fs::path(study.folder) / filled_in(asked.file, values)).string());
        if (!known) return known.error();
        stage.reference = std::move(*known);
    } else if (asked.points > 0) {
        const std::string stem = (folder / "references" / fmt::format("{:016x}", stage.key)).string();
        const ReferenceWork work{options, asked, stage.path, *checked.scene, stem, progress, stop};
        if (const Result<void> added = add_reference(stage, work); !added) return added.error();
    }
    return stage;
}

}  // namespace exitance
