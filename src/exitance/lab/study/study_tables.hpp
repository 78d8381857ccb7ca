#pragma once

#include <span>

#include "exitance/lab/study/study_analysis.hpp"
#include "exitance/lab/study/study_run.hpp"

namespace exitance {

/// A part of the program that computes the tables of a study instead of runs of `solve`: `table = "flatland"`.
struct StudyTableMaker {
    std::string_view name;
    Result<StudyTables> (*make)(const Study&, const StudyOptions&, Progress&, const StopRequest&);
};
std::span<const StudyTableMaker> study_table_makers();

}  // namespace exitance
