#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// A scene of a study, made anew for every value of the study's parameter. "{value}" in its words stands for that.
struct StudyScene {
    std::string name;
    std::string generate;  ///< "complex m={value}", as `generate` takes it; empty where there is a file,
    std::string file;      ///< which is looked up beside the study.
    std::vector<double> values, quick_values;
};

/// A way to solve: the options of `solve`, with "{value}" and "{setting}" replaced.
struct StudyRow {
    std::string label;
    std::string options;
    std::string peer;  ///< Another program, whose options these are then (`peer_names()`); empty: ours.
    std::vector<std::string> settings, quick_settings;      ///< Empty: one run without a setting.
    bool equal_time = true;                                 ///< Does it take part in the table `equal_time`?
    bool quick = true;                                      ///< Is it run with --quick?
    double most = std::numeric_limits<double>::infinity();  ///< Of the parameter; larger values are not run.
    std::vector<std::string> scenes;                        ///< Empty: all.
};

/// Light that errors are measured against, at points uniform in area: a careful solve, held against unbiased paths in
/// the table `references`; or those paths alone, which are exact where nothing reflects; or what a file holds.
struct StudyReference {
    std::string options, quick_options;  ///< Of the careful solve; empty: paths alone.
    std::size_t points = 0, paths = 0;   ///< 0 points: no errors are measured.
    std::size_t quick_points = 0, quick_paths = 0;
    std::string file;  ///< A probe CSV in place of paths, with "{value}" replaced.
};

/// Which rows of a table: a column, and the texts that it may have.
using RowFilter = std::map<std::string, std::vector<std::string>>;

struct StudyPlot {
    std::string name, title;
    std::string table = "results";
    std::string x, y;
    std::string series = "row";  ///< A curve for each text of this column.
    std::string panel;           ///< A picture for each text of this column; empty: one.
    std::string x_label, y_label;
    std::string log;     ///< "", "x", "y" or "xy"
    std::string labels;  ///< A column whose numbers stand above the points of every x; empty: none.
    std::string fit;     ///< "power": exponents of the curves in the legend; "quadratic": a x^2 + b x, drawn, too.
    RowFilter where;
    bool checkpoints = false;  ///< Take solutions on the way, too?
};

/// Which of a study's solutions; what is empty, or NaN, fits all.
struct ChosenSolution {
    std::string row, scene, setting;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< Of the parameter.
    /// Seconds of the method: the last solution on the way that is no later. NaN: the one at the end.
    double at = std::numeric_limits<double>::quiet_NaN();
};

/// Light along a line, for the table `profiles`.
struct StudyLine {
    ChosenSolution of;
    std::string name;
    std::array<double, 3> from{}, to{}, normal{};  ///< Metres.
    std::size_t points = 200;
};

/// Light, the method's mesh, or the left half of one beside the right half of the other, of one solution.
struct StudyPicture {
    ChosenSolution of;
    std::string caption;
    std::string options;  ///< Of `render`.
    enum class Shows : std::uint8_t { light, mesh, halves } shows = Shows::light;
};

/// A number taken from a table, and the range in which a statement holds.
enum class Measure : std::uint8_t {
    value,       ///< The mean of y.
    largest,     ///< Of y.
    last,        ///< y at the largest x.
    slope,       ///< Of log y over log x, by least squares.
    ratio,       ///< The geometric mean of y over y of `against`, row by row of the same scene, parameter and setting.
    last_ratio,  ///< The same at the largest x alone.
    crossing,    ///< The x where y and y of `against` cross; the last such place.
    quadratic,   ///< sigma of y = sigma x^2 + beta x by least squares.
};

struct StudyConclusion {
    std::string says, paper, plot;
    std::string table = "results";
    Measure measure = Measure::value;
    std::string x, y;
    RowFilter where, against;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
};

/// A study: scenes by rows of options by values of a parameter, or a table that a part of the program makes; plots of
/// it, and conclusions from it. See docs/experiments.md.
struct Study {
    std::string name, title, about;
    std::string parameter = "value", unit;
    std::string table;                             ///< Of `study_tables`; empty: runs of `solve`.
    std::map<std::string, std::string> arguments;  ///< Of that table.
    int threads = 1;
    double time_limit = 300, quick_time_limit = 20;  ///< A run, seconds.
    std::string memory_limit = "8G";
    bool ascending = true;    ///< Larger values are harder: after one that took too long they are not run.
    bool equal_time = false;  ///< Make the table `equal_time`.
    std::vector<StudyScene> scenes;
    std::vector<StudyRow> rows;
    StudyReference reference;
    std::vector<StudyPlot> plots;
    std::vector<StudyPicture> pictures;
    std::vector<StudyLine> lines;
    std::vector<StudyConclusion> conclusions;
    std::string text;    ///< As it was read.
    std::string folder;  ///< That file names are relative to.
};

/// Reads a study from TOML. Error: bad_input with file and line, where the text is no TOML, a key is unknown or
/// missing, or a value makes no sense.
Result<Study> parse_study(const std::string& text, const std::string& name, const std::string& file);
Result<Study> load_study(const std::string& path);

/// The studies that the program holds: name and text of each.
struct BuiltInStudy {
    std::string_view name, text;
};
std::span<const BuiltInStudy> built_in_studies();

}  // namespace exitance
