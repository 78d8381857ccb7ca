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

/// A scene of a study, generated for every value of the study's parameter, which replaces "{value}" in its text.
struct StudyScene {
    std::string name;
    std::string generate;  ///< Arguments of `generate`, for example "complex m={value}"; empty if `file` is given.
    std::string file;      ///< Scene file, relative to the study's folder.
    std::vector<double> values, quick_values;
};

/// A way to solve: the options of `solve`, in which "{value}" and "{setting}" are replaced.
struct StudyRow {
    std::string label;
    std::string options;
    std::string peer;  ///< Another program that these options are for (`peer_names()`); empty: this one.
    std::vector<std::string> settings, quick_settings;      ///< Settings to run; empty: one run without a setting.
    bool equal_time = true;                                 ///< True if included in the table `equal_time`.
    bool quick = true;                                      ///< True if run with --quick.
    double most = std::numeric_limits<double>::infinity();  ///< Largest value of the parameter that is run.
    std::vector<std::string> scenes;                        ///< Scenes to run; empty: all.
};

/// Reference light for errors, at points uniform in area. It is a careful solve, compared with unbiased paths in the
/// table `references`; or those paths only, which are exact if nothing reflects; or the contents of a file.
struct StudyReference {
    std::string options, quick_options;  ///< Options of the careful solve; empty: only paths.
    std::size_t points = 0, paths = 0;   ///< Size of the reference; 0 points: errors are not measured.
    std::size_t quick_points = 0, quick_paths = 0;
    std::string file;  ///< Probe CSV file instead of paths, in which "{value}" is replaced.
};

/// Filter of a table's rows: accepted texts per column.
using RowFilter = std::map<std::string, std::vector<std::string>>;

struct StudyPlot {
    std::string name, title;
    std::string table = "results";
    std::string x, y;
    std::string series = "row";  ///< Column with the names of curves.
    std::string panel;           ///< Column with the names of panels, one picture each; empty: one picture.
    std::string x_label, y_label;
    std::string log;     ///< "", "x", "y" or "xy"
    std::string labels;  ///< Column of numbers to print above the points of every x; empty: none.
    std::string fit;     ///< "power": exponents of the curves in the legend; "quadratic": also draws a x^2 + b x.
    RowFilter where;
    bool checkpoints = false;  ///< True if intermediate solutions are included.
};

/// Selects solutions of a study; empty fields and NaN match all.
struct ChosenSolution {
    std::string row, scene, setting;
    double value = std::numeric_limits<double>::quiet_NaN();  ///< Value of the parameter.
    /// Seconds of the method: selects the last intermediate solution up to then. NaN: the final one.
    double at = std::numeric_limits<double>::quiet_NaN();
};

/// Light along a line, for the table `profiles`.
struct StudyLine {
    ChosenSolution of;
    std::string name;
    std::array<double, 3> from{}, to{}, normal{};  ///< Metres.
    std::size_t points = 200;
};

/// A picture of one solution: light, the method's mesh, or the left half of one and the right half of the other.
struct StudyPicture {
    ChosenSolution of;
    std::string caption;
    std::string options;  ///< Options of `render`.
    enum class Shows : std::uint8_t { light, mesh, halves } shows = Shows::light;
};

/// A drawing of the shapes in a table; see study_drawings.hpp for its columns. Each value of the column `drawing` is
/// one picture.
struct StudyDrawing {
    std::string name, title, table;
    std::string x_label, y_label;  ///< Labels of the axes; empty: no axis.
    bool equal_axes = false;       ///< True if a unit is as long on both axes.
    RowFilter where;
};

/// A figure or table of a publication, and the study that repeats it.
struct StudyItem {
    std::string shows;
    std::string study;   ///< Name of a built-in study; empty if there is none.
    std::string says;    ///< Start of the conclusions of that study that judge the item; empty: none judges it.
    std::string reason;  ///< Explains an item that is not made or judged, or a claim that does not hold.
};

/// A number computed from a table, to be compared with the range in which a statement holds.
enum class Measure : std::uint8_t {
    value,             ///< Mean of y.
    largest,           ///< Largest y.
    last,              ///< y at the largest x.
    slope,             ///< Slope of log y over log x, by least squares.
    ratio,             ///< Geometric mean of y / (y of `against`), for rows of the same scene, parameter and setting.
    last_ratio,        ///< Like `ratio`, but only at the largest x.
    crossing,          ///< Last x at which y and y of `against` cross.
    quadratic_misfit,  ///< Relative RMS error of the fit y = sigma x^2 + beta x by least squares.
};

struct StudyConclusion {
    std::string says, paper, plot;
    std::string table = "results";
    Measure measure = Measure::value;
    std::string x, y;
    RowFilter where, against;
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
};

/// A study: scenes by rows of options by values of a parameter, or a table that a part of the program computes; plots
/// of it, and conclusions from it. See docs/laboratory/test_bed.md.
struct Study {
    std::string name, title, about;
    std::string parameter = "value", unit;
    std::string table;                             ///< One of `study_tables`; empty: runs of `solve`.
    std::map<std::string, std::string> arguments;  ///< Arguments of that table.
    int threads = 1;
    double time_limit = 300, quick_time_limit = 20;  ///< Seconds per run.
    std::string memory_limit = "8G";
    bool ascending = true;  ///< Larger values take longer: after a run that exceeds its limit, larger ones are skipped.
    bool equal_time = false;  ///< Compute the table `equal_time`.
    std::vector<StudyScene> scenes;
    std::vector<StudyRow> rows;
    StudyReference reference;
    std::vector<StudyPlot> plots;
    std::vector<StudyPicture> pictures;
    std::vector<StudyLine> lines;
    std::vector<StudyConclusion> conclusions;
    std::vector<StudyDrawing> drawings;
    std::vector<StudyItem> items;  ///< For the table `items`.
    std::string text;              ///< Original text.
    std::string folder;            ///< Folder that file names are relative to.
};

/// Parses a study from TOML. Error: bad_input with file and line, if the text is not TOML, a key is unknown or missing,
/// or a value is invalid.
Result<Study> parse_study(const std::string& text, const std::string& name, const std::string& file);
Result<Study> load_study(const std::string& path);

/// Name and text of a study that is built into the program.
struct BuiltInStudy {
    std::string_view name, text;
};
std::span<const BuiltInStudy> built_in_studies();

}  // namespace exitance
