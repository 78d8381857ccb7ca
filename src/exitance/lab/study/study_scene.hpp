#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exitance/lab/study/study_run.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// A scene of a study for one value of its parameter.
struct StudyStage {
    std::string path;       ///< Of its file.
    std::string words;      ///< What it is made by, for people: "complex m=6".
    std::uint64_t key = 0;  ///< Of what runs depend on: its content and its reference.
    std::size_t polygons = 0;
    std::optional<ReferencePoints> reference;
    std::optional<ErrorMeasure> check;  ///< Of a reference that is a careful solve, against paths.
};

/// Words between blanks; those in quotation marks of either kind are one.
std::vector<std::string> split_words(const std::string& text);
/// `text` with "{name}" replaced, for all names.
std::string filled_in(std::string text, const std::vector<std::pair<std::string, std::string>>& values);
/// A key of a text, the same on all machines.
std::uint64_t key_of(std::string_view text);

/// Makes the scene (FOLDER/scenes) and its reference (FOLDER/references), unless they are there.
Result<StudyStage> prepare_scene(const Study& study, const StudyScene& scene, double value, const StudyOptions& options,
                                 Progress& progress, const StopRequest& stop);

}  // namespace exitance
