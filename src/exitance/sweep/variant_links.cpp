#include "exitance/sweep/variant_links.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/sweep/sweep_json.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_file = "variant.json";
constexpr std::size_t min_digits = 4;  ///< Digits of a variant's number in the name of its folder.
constexpr int max_replacements = 3;    ///< Attempts to replace a folder that other processes write, too.

bool is_current(const std::string& folder, const std::string& record) {
    const Result<std::string> present = read_whole_file((fs::path(folder) / record_file).string());
    return present && *present == record;
}

/// Links the files of a step into `folder`, a folder beside those of the variants.
void link_files(const ResolvedStep& step, const std::string& from, const std::string& folder) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(from, ignored)) {
        std::string name = entry.path().filename().string();
        if (name == "status.txt") continue;
        if (name == "stdout.txt" || name == "stderr.txt") name = fmt::format("{}.{}", step.name, name);
        const fs::path target = fs::path("../../steps") / step.key / entry.path().filename();
        fs::create_symlink(target, fs::path(folder) / name, ignored);
    }
}

}  // namespace

std::string variant_folder(const SweepPlan& plan, std::size_t index) {
    const std::size_t digits = std::max(min_digits, std::to_string(plan.variants.size()).size());
    return (fs::path(plan.folder) / "variants" / fmt::format("{:0{}}", index + 1, digits)).string();
}

Result<void> link_variant(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant) {
    const std::string folder = variant_folder(plan, index), record = variant_json(plan, index, variant);
    if (is_current(folder, record)) return {};
    const fs::path parent = fs::path(folder).parent_path();
    std::error_code failed;
    fs::create_directories(parent, failed);
    std::string scratch = (parent / fmt::format(".{}.XXXXXX", fs::path(folder).filename().string())).string();
    const bool is_made = !failed && ::mkdtemp(scratch.data());
    // A folder within the scratch folder has the usual permissions.
    const std::string work = (fs::path(scratch) / "variant").string();
    if (!is_made || !fs::create_directory(work, failed))
        return Error{ErrorCode::cannot_write, "cannot be written", parent.string(), "check the space on the disk"};
    for (const ResolvedStep& step : variant.steps)
        link_files(step, (fs::path(step_folder(plan)) / step.key).string(), work);
    Result<void> written = write_file((fs::path(work) / record_file).string(), record);
    std::error_code ignored;
    for (int attempt = 0; written && attempt < max_replacements; ++attempt) {
        fs::rename(work, folder, failed);
        if (!failed || is_current(folder, record)) break;
        fs::remove_all(folder, ignored);
    }
    fs::remove_all(scratch, ignored);
    return written;
}

}  // namespace exitance
