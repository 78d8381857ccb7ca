#include "exitance/lab/study/study_items.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

namespace exitance {
namespace {

/// A study and its result, whose verdicts refer to it.
struct ConductedStudy {
    Study study;
    StudyReport report;
};

const char* word_of(Verdict::Holds holds) {
    switch (holds) {
        case Verdict::Holds::yes:
            return "holds";
        case Verdict::Holds::no:
            return "does not hold";
        case Verdict::Holds::not_judged:
            return "quick run, not judged";
        case Verdict::Holds::unknown:
            break;
    }
    return "not measured";
}

Result<std::unique_ptr<ConductedStudy>> conduct_part(const std::string& name, const StudyOptions& options,
                                                     Progress& progress, const StopRequest& stop) {
    const auto all = built_in_studies();
    const auto at = std::find_if(all.begin(), all.end(), [&](const BuiltInStudy& built) { return built.name == name; });
    if (at == all.end())
        return Error{ErrorCode::bad_input, fmt::format("there is no built-in study '{}'", name), name,
                     "exitance experiment list shows them"};
    Result<Study> study = parse_study(std::string(at->text), name, name + ".toml");
    if (!study) return study.error();
    StudyOptions own = options;
    own.folder = (std::filesystem::path(options.folder) / name).string();
    auto part = std::make_unique<ConductedStudy>();
    part->study = std::move(*study);
    Result<StudyReport> report = conduct_study(part->study, own, progress, stop);
    if (!report) return report.error();
    part->report = std::move(*report);
    return part;
}

}  // namespace

Result<Table> rows_of_item(const StudyItem& item, const StudyReport* report) {
    Table table;
    const auto add = [&](const std::string& statement, const std::string& judgement, const std::string& measured) {
        table.add_row();
        table.set("item", item.shows), table.set("study", item.study);
        table.set("command", report ? fmt::format("exitance experiment {} -o {}", item.study, item.study) : "");
        table.set("statement", statement), table.set("judgement", judgement), table.set("measured", measured);
        table.set("reason", item.reason);
    };
    if (!report) return add("", "not made", ""), table;
    if (item.says.empty()) return add("", "made, not judged", ""), table;
    for (const Verdict& verdict : report->verdicts)
        if (verdict.conclusion->says.starts_with(item.says))
            add(verdict.conclusion->says, word_of(verdict.holds), verdict.detail);
    if (table.rows.empty())
        return Error{ErrorCode::bad_input, fmt::format("no conclusion of '{}' starts with '{}'", item.study, item.says),
                     item.shows, "correct 'says' of the item"};
    return table;
}

Result<StudyTables> item_tables(const Study& study, const StudyOptions& options, Progress& progress,
                                const StopRequest& stop) {
    std::map<std::string, std::unique_ptr<ConductedStudy>> parts;
    Table results;
    for (const StudyItem& item : study.items) {
        if (stop.requested()) break;
        if (!item.study.empty() && !parts.contains(item.study)) {
            Result<std::unique_ptr<ConductedStudy>> part = conduct_part(item.study, options, progress, stop);
            if (!part) return part.error();
            parts[item.study] = std::move(*part);
        }
        const Result<Table> rows = rows_of_item(item, item.study.empty() ? nullptr : &parts[item.study]->report);
        if (!rows) return rows.error();
        results.append(*rows);
    }
    return StudyTables{{"results", std::move(results)}};
}

std::vector<std::string> plots_of_part(const std::string& folder, const std::string& study) {
    std::vector<std::string> paths;
    std::error_code failed;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(folder) / study / "plots", failed))
        if (entry.path().extension() == ".svg") paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    return paths;
}

}  // namespace exitance
