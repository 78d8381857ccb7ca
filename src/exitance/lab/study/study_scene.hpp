#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/base/words.hpp"
#include "exitance/lab/study/study_run.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// A scene of a study for one value of its parameter.
struct StudyStage {
    std::string path;       ///< Path of its file.
    std::string words;      ///< Readable description of its origin, for example "complex m=6".
    std::uint64_t key = 0;  ///< Key of everything that runs depend on: its content and its reference.
    std::size_t polygons = 0;
    std::optional<ReferencePoints> reference;
    std::optional<ErrorMeasure> check;  ///< Error against paths, if the reference is a careful solve.
};

/// Key of a text, equal on all machines.
std::uint64_t key_of(std::string_view text);

/// Generates the scene (FOLDER/scenes) and its reference (FOLDER/references) unless they exist.
Result<StudyStage> prepare_scene(const Study& study, const StudyScene& scene, double value, const StudyOptions& options,
                                 Progress& progress, const StopRequest& stop);

}  // namespace exitance
