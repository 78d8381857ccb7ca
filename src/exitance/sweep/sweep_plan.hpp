#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Value of a parameter: one word of a command, or, for lists in the plan, any number of words.
using SweepValue = std::vector<std::string>;

/// Values of some parameters, in the order of the plan.
using SweepSetting = std::vector<std::pair<std::string, SweepValue>>;

/// A step of the chain: a command of exitance with placeholders.
struct SweepStep {
    std::string name;
    std::vector<std::string> words;   ///< Verb and arguments, with placeholders such as "{dir}/room.h5".
    std::vector<int> accepted{0};     ///< Exit statuses with which the step counts as finished.
    std::vector<std::string> inputs;  ///< Further files that the command reads, with placeholders; may have wildcards.
    int line = 0;                     ///< Line of the plan.
};

/// Scene made from texts with placeholders "{{name}}". The first file is the scene.
struct SweepTemplate {
    std::vector<std::string> files;
    int line = 0;
};

/// A value that is collected from the results of every variant.
struct SweepOutput {
    enum class Take { value, mean, sum, min, max, all };

    std::string name;
    std::string step;    ///< Step whose standard output is the file for `json`; empty: `file` is used.
    std::string file;    ///< File below {dir}; empty: the standard output of `step`.
    std::string json;    ///< Key in a JSON file, such as "energy.emitted" or "rooms.0.mean"; empty: `column` is used.
    std::string column;  ///< Column of a CSV file.
    Take take = Take::value;
    std::size_t row = 1;  ///< Row of the CSV file, from 1, for Take::value.
    int line = 0;
};

/// Plan of a sweep: variants of a scene and of options, the steps that each variant takes, and the values to collect.
struct SweepPlan {
    std::string path;    ///< The plan's file.
    std::string base;    ///< Folder of the plan, in which commands run. Absolute.
    std::string folder;  ///< Folder of all results. Absolute.
    std::string title;
    std::vector<std::string> parameters;  ///< Names of the parameters, in the order of the plan.
    std::vector<SweepSetting> variants;   ///< All parameters of every variant, in the order of `parameters`.
    SweepTemplate scene_template;         ///< Has no files if the scene is not made from a template.
    std::vector<SweepStep> steps;         ///< A generated scene is the first step, called "scene".
    std::vector<SweepOutput> outputs;
    std::string scene;  ///< Text that replaces {scene}: a path below {dir}. Empty if the plan has no such placeholder.
};

/// Parses a plan (docs/sweeps.md). `path` is the name of the file in messages, and its folder that of relative paths.
/// Errors: bad_input, with line and key.
Result<SweepPlan> parse_sweep_plan(const std::string& text, const std::string& path);
/// Reads a plan from a file.
Result<SweepPlan> load_sweep_plan(const std::string& path);

/// Text of a value in tables: its words, joined by blanks.
std::string text_of(const SweepValue& value);

/// Removes the blanks within placeholders: "{ name }" becomes "{name}".
std::string with_plain_placeholders(const std::string& text);
/// Shortest spelling of a path below {dir}: "a/../b//c/" becomes "b/c". Empty if the path leaves {dir} or is {dir}.
std::string path_in_folder(const std::string& path);

/// Replaces placeholders "{name}" by the values of a variant. "{dir}" and "{scene}" stay. A word that is a single
/// placeholder becomes one word per word of its value. Error: bad_input for an unknown name, at the line `line`.
Result<std::vector<std::string>> fill_in(const SweepPlan& plan, const std::vector<std::string>& words,
                                         const SweepSetting& variant, int line);

}  // namespace exitance
