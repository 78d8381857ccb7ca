#include "exitance/sweep/variant_links.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <vector>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/files/write_error.hpp"
#include "exitance/sweep/step_record.hpp"
#include "exitance/sweep/sweep_json.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr const char* record_file = "variant.json";
constexpr std::size_t min_digits = 4;     ///< Digits of a variant's number in the name of its folder.
constexpr std::size_t max_digits = 7;     ///< Digits of the largest number of variants.
constexpr int max_link_replacements = 3;  ///< Attempts to replace a folder that other processes write, too.

/// A link in the folder of a variant.
struct VariantLink {
    fs::path name;    ///< Path below the folder.
    fs::path target;  ///< Relative to the folder of the link.
};

/// Links to the files of all steps. Folders are real ones, as several steps may write into one.
std::vector<VariantLink> links_of(const SweepPlan& plan, const ResolvedVariant& variant) {
    std::vector<VariantLink> links;
    std::error_code failed;
    for (const ResolvedStep& step : variant.steps) {
        const fs::path from = fs::path(step_folder(plan)) / step.key;
        for (auto at = fs::recursive_directory_iterator(from, failed); !failed && at != fs::end(at);
             at.increment(failed)) {
            if (at->is_directory()) continue;
            const fs::path path = at->path().lexically_relative(from);
            const bool is_printed = path == "stdout.txt" || path == "stderr.txt";
            if (path == step_record_file) continue;
            fs::path target = fs::path("../../steps") / step.key / path;
            for (int i = 0; i < at.depth(); ++i) target = ".." / target;
            links.push_back({is_printed ? fs::path(fmt::format("{}.{}", step.name, path.string())) : path, target});
        }
    }
    return links;
}

bool has_record(const std::string& folder, const std::string& record) {
    const Result<std::string> present = read_whole_file((fs::path(folder) / record_file).string());
    return present && *present == record;
}

bool is_current(const std::string& folder, const std::string& record, const std::vector<VariantLink>& links) {
    std::error_code ignored;
    return has_record(folder, record) && std::all_of(links.begin(), links.end(), [&](const VariantLink& link) {
               return fs::exists(fs::path(folder) / link.name, ignored);
           });
}

/// Makes links and the record in `folder`. Names that exist stay.
Result<void> fill(const fs::path& folder, const std::vector<VariantLink>& links, const std::string& record) {
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    for (const VariantLink& link : links) {
        fs::create_directories((folder / link.name).parent_path(), ignored);
        fs::create_symlink(link.target, folder / link.name, ignored);
    }
    return write_file((folder / record_file).string(), record);
}

/// True for a link that fill() makes.
bool is_own_link(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_symlink(path, ignored)) return false;
    const std::string target = fs::read_symlink(path, ignored).string();
    return target.starts_with("../../") && target.find("/steps/") != std::string::npos;
}

/// Removes the links and the record in a folder of a variant, and the folders that are empty without them.
void remove_own_files(const fs::path& folder) {
    std::error_code failed;
    if (!fs::is_directory(fs::symlink_status(folder, failed))) return;
    std::vector<fs::path> links, folders{folder};
    for (auto at = fs::recursive_directory_iterator(folder, failed); !failed && at != fs::end(at);
         at.increment(failed)) {
        if (is_own_link(at->path()))
            links.push_back(at->path());
        else if (at->is_directory(failed) && !at->is_symlink(failed))
            folders.push_back(at->path());
    }
    for (const fs::path& link : links) fs::remove(link, failed);
    fs::remove(folder / record_file, failed);
    // Folders are listed before those in them. A folder that is not empty is not removed.
    for (std::size_t i = folders.size(); i-- > 0;) fs::remove(folders[i], failed);
}

std::string plan_name(const SweepPlan& plan) {
    return fs::path(plan.path).filename().string();
}

}  // namespace

std::string variant_folder(const SweepPlan& plan, std::size_t index) {
    const std::size_t digits = std::max(min_digits, std::to_string(plan.variants.size()).size());
    return (fs::path(plan.folder) / "variants" / fmt::format("{:0{}}", index + 1, digits)).string();
}

Result<void> link_variant(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant) {
    const std::string folder = variant_folder(plan, index), record = variant_json(plan, index, variant);
    const std::vector<VariantLink> links = links_of(plan, variant);
    if (is_current(folder, record, links)) return {};
    const fs::path parent = fs::path(folder).parent_path();
    std::error_code failed;
    fs::create_directories(parent, failed);
    if (failed) return cannot_write(parent.string(), failed.value());
    std::string scratch = (parent / fmt::format(".{}.XXXXXX", fs::path(folder).filename().string())).string();
    if (!::mkdtemp(scratch.data())) return cannot_write(parent.string(), errno);
    // A folder within the scratch folder has the usual permissions.
    const std::string work = (fs::path(scratch) / "variant").string();
    Result<void> written = fill(work, links, record);
    for (int attempt = 0; written && attempt < max_link_replacements; ++attempt) {
        fs::rename(work, folder, failed);
        if (!failed || is_current(folder, record, links)) break;
        remove_own_files(folder);
    }
    // A folder with files of the user is not replaced but filled.
    if (written && failed && !is_current(folder, record, links)) written = fill(folder, links, record);
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    if (written) return {};
    Error error = written.error();
    error.where = folder;
    return error;
}

void remove_if_stale(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant) {
    const std::string folder = variant_folder(plan, index);
    const Result<std::string> text = read_whole_file((fs::path(folder) / record_file).string());
    if (text && parse_variant(*text) && *text != variant_json(plan, index, variant)) remove_own_files(folder);
}

void remove_extra_variants(const SweepPlan& plan) {
    const fs::path parent = fs::path(variant_folder(plan, 0)).parent_path();
    std::vector<fs::path> extra;
    std::error_code failed;
    for (auto at = fs::directory_iterator(parent, failed); !failed && at != fs::end(at); at.increment(failed)) {
        const std::string name = at->path().filename().string();
        if (name.size() > max_digits || name.find_first_not_of("0123456789") != std::string::npos) continue;
        const std::size_t number = std::stoul(name);
        const bool is_named =
            number >= 1 && number <= plan.variants.size() && variant_folder(plan, number - 1) == at->path();
        if (!is_named) extra.push_back(at->path());
    }
    for (const fs::path& folder : extra) {
        const Result<std::string> text = read_whole_file((folder / record_file).string());
        const std::optional<VariantRecord> record = text ? parse_variant(*text) : std::nullopt;
        // Plans may share a folder.
        const bool is_own = record && (record->plan.empty() || record->plan == plan_name(plan));
        if (is_own && record->number == std::stoul(folder.filename().string())) remove_own_files(folder);
    }
}

}  // namespace exitance
