#include "exitance/sweep/sweep_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "exitance/io/files/table.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/sweep/sweep_json.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Mean, sum, least or largest of numbers, of which there is at least one.
double combined(const std::vector<double>& values, SweepOutput::Take take) {
    if (take == SweepOutput::Take::min) return *std::min_element(values.begin(), values.end());
    if (take == SweepOutput::Take::max) return *std::max_element(values.begin(), values.end());
    double sum = 0;
    for (const double value : values) sum += value;
    return take == SweepOutput::Take::sum ? sum : sum / static_cast<double>(values.size());
}

/// Values of an output in a CSV file.
Result<std::vector<std::string>> values_in_csv(const SweepOutput& output, const std::string& text,
                                               const std::string& path) {
    const Result<Table> table = parse_csv(text, path);
    if (!table) return table.error();
    if (!table->has(output.column))
        return Error{
            ErrorCode::bad_input,
            fmt::format("there is no column '{}', the columns are {}", output.column, fmt::join(table->columns, ", ")),
            path, ""};
    if (table->count(output.column) > 1)
        return Error{ErrorCode::bad_input,
                     fmt::format("there are {} columns '{}'", table->count(output.column), output.column), path,
                     "rename one of them"};
    if (output.take == SweepOutput::Take::value) {
        if (output.row > table->rows.size())
            return Error{ErrorCode::bad_input,
                         fmt::format("there are {} rows, so there is no row {}", table->rows.size(), output.row), path,
                         ""};
        return std::vector<std::string>{table->text(output.row - 1, output.column)};
    }
    std::vector<std::string> texts;
    std::vector<double> numbers;
    for (std::size_t row = 0; row < table->rows.size(); ++row) {
        texts.push_back(table->text(row, output.column));
        numbers.push_back(table->number(row, output.column));
    }
    if (output.take == SweepOutput::Take::all) return texts;
    if (numbers.empty()) return Error{ErrorCode::bad_input, "there are no rows", path, ""};
    const double value = combined(numbers, output.take);
    if (!std::isfinite(value))
        return Error{ErrorCode::bad_input, fmt::format("column '{}' has cells that are not numbers", output.column),
                     path, ""};
    return std::vector<std::string>{fmt::format("{}", value)};
}

/// Values of an output for one variant, whose step has the folder `folder`.
Result<std::vector<std::string>> values_of(const SweepOutput& output, const std::string& folder) {
    const std::string path = (fs::path(folder) / (output.file.empty() ? "stdout.txt" : output.file)).string();
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    if (output.json.empty()) return values_in_csv(output, *text, path);
    const std::optional<std::string> value = json_value(*text, output.json);
    if (!value) return Error{ErrorCode::bad_input, fmt::format("there is no value '{}'", output.json), path, ""};
    return std::vector<std::string>{*value};
}

SweepColumn numbers_of_variants(std::size_t rows) {
    SweepColumn column{"variant", {}, false};
    for (std::size_t row = 0; row < rows; ++row) column.cells.push_back({std::to_string(row + 1)});
    return column;
}

std::size_t width_of(const SweepColumn& column) {
    std::size_t width = column.is_list ? 0 : 1;
    for (const std::vector<std::string>& cells : column.cells) width = std::max(width, cells.size());
    return width;
}

/// The cells of a column as numbers, `width` per row; empty if one of them is other text.
std::vector<double> numbers_in(const SweepColumn& column, std::size_t width) {
    std::vector<double> out;
    for (const std::vector<std::string>& cells : column.cells)
        for (std::size_t i = 0; i < width; ++i) {
            if (i >= cells.size() || cells[i].empty()) {
                out.push_back(missing);
                continue;
            }
            const std::optional<double> number = parse_number(cells[i]);
            if (!number) return {};
            out.push_back(*number);
        }
    return out;
}

std::vector<std::string> texts_in(const SweepColumn& column, std::size_t at) {
    std::vector<std::string> out;
    for (const std::vector<std::string>& cells : column.cells) out.push_back(at < cells.size() ? cells[at] : "");
    return out;
}

}  // namespace

SweepResults collect_results(const SweepPlan& plan, const std::vector<VariantState>& states) {
    SweepResults out;
    out.rows = states.size();
    out.columns.push_back(numbers_of_variants(states.size()));
    SweepColumn state{"state", {}, false};
    for (std::size_t i = 0; i < states.size(); ++i) {
        state.cells.push_back({name_of(states[i].kind)});
        if (states[i].kind != VariantState::Kind::done)
            out.problems.push_back(
                fmt::format("variant {} is missing: {}", i + 1,
                            states[i].failure.empty() ? name_of(states[i].kind) : states[i].failure));
    }
    out.columns.push_back(std::move(state));
    for (std::size_t p = 0; p < plan.parameters.size(); ++p) {
        SweepColumn column{plan.parameters[p], {}, false};
        for (const SweepSetting& variant : plan.variants) column.cells.push_back({text_of(variant[p].second)});
        out.columns.push_back(std::move(column));
    }
    for (std::size_t o = 0; o < plan.outputs.size(); ++o) {
        const SweepOutput& output = plan.outputs[o];
        SweepColumn column{output.name, {}, output.take == SweepOutput::Take::all};
        for (std::size_t i = 0; i < states.size(); ++i) {
            std::vector<std::string>& cells = column.cells.emplace_back();
            if (states[i].kind != VariantState::Kind::done) continue;
            const ResolvedVariant& variant = states[i].variant;
            const std::string& key = variant.steps[variant.output_steps[o]].key;
            Result<std::vector<std::string>> values = values_of(output, (fs::path(step_folder(plan)) / key).string());
            if (values)
                cells = std::move(*values);
            else
                out.problems.push_back(fmt::format("variant {} has no value of '{}': {}: {}", i + 1, output.name,
                                                   values.error().where, values.error().message));
        }
        out.columns.push_back(std::move(column));
    }
    return out;
}

Result<void> write_results_csv(const SweepResults& results, const std::string& path) {
    Table table;
    for (std::size_t row = 0; row < results.rows; ++row) table.add_row();
    for (const SweepColumn& column : results.columns) {
        const std::size_t width = width_of(column);
        for (std::size_t i = 0; i < width; ++i) {
            table.columns.push_back(column.is_list ? fmt::format("{}_{}", column.name, i + 1) : column.name);
            const std::vector<std::string> texts = texts_in(column, i);
            for (std::size_t row = 0; row < results.rows; ++row) table.rows[row].push_back(texts[row]);
        }
    }
    return write_csv(path, table);
}

Result<void> write_results_hdf5(const SweepResults& results, const SweepPlan& plan, const std::string& path) {
    const std::string group = "sweep";
    Hdf5Writer file(path);
    file.make_group(group);
    file.set_attribute(group, "title", plan.title);
    file.set_attribute(group, "plan", fs::path(plan.path).filename().string());
    for (const SweepColumn& column : results.columns) {
        const std::size_t width = width_of(column);
        if (width == 0) continue;  // no variant has a value for this output
        std::string name = column.name;
        std::replace(name.begin(), name.end(), '/', '_');
        const Hdf5Label label{"1", column.name.c_str()};
        const std::vector<double> numbers = numbers_in(column, width);
        if (!numbers.empty()) {
            file.write(fmt::format("{}/{}", group, name), numbers, width, label);
            continue;
        }
        for (std::size_t i = 0; i < width; ++i)
            file.write_texts(
                column.is_list ? fmt::format("{}/{}_{}", group, name, i + 1) : fmt::format("{}/{}", group, name),
                texts_in(column, i), label);
    }
    return file.commit();
}

}  // namespace exitance
