#include "exitance/io/solution/checkpoint_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

/// Returns the generation if `name` is a part of `checkpoint` (file names without folders); otherwise empty.
std::optional<std::uint64_t> generation_in(std::string_view name, std::string_view checkpoint) {
    if (!name.starts_with(checkpoint)) return {};
    std::array<std::uint64_t, 2> numbers{};  // the generation and the number of the process
    const char* at = name.data() + checkpoint.size();
    const char* const end = name.data() + name.size();
    for (std::uint64_t& number : numbers) {
        if (at == end || *at != '.') return {};
        const auto [rest, failed] = std::from_chars(at + 1, end, number);
        if (failed != std::errc()) return {};
        at = rest;
    }
    return at == end ? std::optional(numbers[0]) : std::nullopt;
}

/// Calls `take` for each part of a checkpoint, with its generation.
void for_each_part(const std::string& checkpoint,
                   const std::function<void(const std::filesystem::path&, std::uint64_t)>& take) {
    const std::filesystem::path path(checkpoint);
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::vector<std::filesystem::path> names;  // list all names first, since `take` may remove files
    std::error_code failed;
    for (std::filesystem::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
        names.push_back(at->path());
    for (const std::filesystem::path& name : names)
        if (const auto generation = generation_in(name.filename().string(), path.filename().string()))
            take(name, *generation);
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
    std::uint64_t sum = bytes.size();
    for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(8, bytes.size()))) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data(), std::min<std::size_t>(8, bytes.size()));
        sum = hash(sum ^ word);
    }
    return sum;
}

std::string checkpoint_part_path(const std::string& checkpoint, std::uint64_t generation, std::size_t process) {
    return fmt::format("{}.{}.{}", checkpoint, generation, process);
}

Result<std::string> read_checkpoint_part(const std::string& checkpoint, std::uint64_t generation, std::size_t process,
                                         const CheckpointPart& expected) {
    const std::string path = checkpoint_part_path(checkpoint, generation, process);
    const auto refused = [&](std::string message) {
        return Error{
            ErrorCode::bad_input, std::move(message), path,
            "put back the file that was written with " + checkpoint + ", or begin the solve anew, without --resume"};
    };
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return refused("is missing, and is a part of the checkpoint");
    Result<std::string> content = read_whole_file(path);
    if (!content) return content.error();
    if (content->size() != expected.size)
        return refused(
            fmt::format("has {} bytes, and as a part of the checkpoint had {}", content->size(), expected.size));
    if (checksum(*content) != expected.sum) return refused("is damaged, or a part of another checkpoint");
    return content;
}

std::uint64_t last_checkpoint_generation(const std::string& checkpoint) {
    std::uint64_t last = 0;
    for_each_part(checkpoint, [&](const auto&, std::uint64_t generation) { last = std::max(last, generation); });
    return last;
}

void remove_checkpoint_parts(const std::string& checkpoint, std::uint64_t first, std::uint64_t end) {
    for_each_part(checkpoint, [&](const std::filesystem::path& path, std::uint64_t generation) {
        std::error_code ignored;
        if (generation >= first && generation < end) std::filesystem::remove(path, ignored);
    });
}

}  // namespace exitance
