#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "exitance/base/memory.hpp"
#include "exitance/processes/team.hpp"

// Memory that the processes of a node share: whole pages of arrays that are the same in all of them, or that they fill
// in common.

namespace exitance {
namespace {

/// Writes bytes at offset `place` of a file; returns false on failure.
bool write_to(int file, std::size_t place, std::span<const char> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (written <= 0) return false;
        place += static_cast<std::size_t>(written), bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// True in all processes of the node if `own` is true in all of them.
bool all_on_node(bool own) {
    int value = own ? 1 : 0, all = 0;
    reduce(&value, &all, 1, MPI_INT, MPI_MIN, team.node);
    return all == 1;
}

/// True if two numbers are equal in all processes of the node.
bool is_alike_on_node(std::size_t a, std::size_t b) {
    std::array<std::uint64_t, 4> own{a, ~std::uint64_t{a}, b, ~std::uint64_t{b}}, all{};
    reduce(own.data(), all.data(), 4, MPI_UINT64_T, MPI_MAX, team.node);
    return all == own;
}

}  // namespace

namespace detail {
namespace {

/// Whole pages of an array; empty unless they make at least `least` bytes and have the same layout in all processes of
/// the node.
std::span<char> whole_pages(std::span<char> array, std::size_t least) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t skipped = (page - reinterpret_cast<std::uintptr_t>(array.data()) % page) % page;
    if (team.node_size == 1 || array.size() < least + page || !is_alike_on_node(skipped, array.size())) return {};
    return array.subspan(skipped, (array.size() - skipped) / page * page);
}

/// Creates a memory file of `size` bytes in the first process of the node, which the others open under its name in
/// /proc. Returns -1 in all of them if one fails.
int file_of_node(std::size_t size) {
    int rank = 0;
    MPI_Comm_rank(team.node, &rank);
    int file = rank == 0 ? memfd_create("exitance", MFD_CLOEXEC) : -1;
    if (file >= 0 && ftruncate(file, static_cast<off_t>(size)) != 0) close(std::exchange(file, -1));
    std::array<std::int64_t, 2> place{getpid(), file};
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(place.data(), 2, MPI_INT64_T, 0, team.node, &request);
    wait_for(request);
    if (rank != 0 && place[1] >= 0) {
        const std::string path = "/proc/" + std::to_string(place[0]) + "/fd/" + std::to_string(place[1]);
        file = open(path.c_str(), O_RDWR | O_CLOEXEC);
    }
    if (all_on_node(file >= 0)) return file;
    if (file >= 0) close(file);
    return -1;
}

/// Maps pages to a file at offset `place`. `kind`: MAP_SHARED or MAP_PRIVATE; a page of a private mapping becomes the
/// process's own on the first write. Ends the job on failure.
void map_pages(std::span<char> pages, int file, std::size_t place, int kind) {
    if (mmap(pages.data(), pages.size(), PROT_READ | PROT_WRITE, kind | MAP_FIXED, file, static_cast<off_t>(place)) ==
        MAP_FAILED)
        end_job("the system does not allow more shared memory");
    // Populates all pages at once where the system supports it: page faults one by one cost several times as much.
    madvise(pages.data(), pages.size(), kind == MAP_SHARED ? MADV_POPULATE_WRITE : MADV_POPULATE_READ);
}

/// Copies the pages of the node's first process to the file and maps the file in their place, in parts, so that little
/// memory is used twice.
void move_pages(std::span<char> pages, int file, int kind) {
    constexpr std::size_t min_step = std::size_t(1) << 23,
                          max_parts = 64;  // the number of mappings is limited by the system
    const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE)),
                      step = std::max(min_step, (pages.size() / max_parts / page + 1) * page);
    int rank = 0;
    MPI_Comm_rank(team.node, &rank);
    for (std::size_t first = 0; first < pages.size(); first += step) {
        const std::span<char> part = pages.subspan(first, std::min(step, pages.size() - first));
        if (!all_on_node(rank != 0 || write_to(file, first, part))) end_job("no memory is left for processes to share");
        map_pages(part, file, first, kind);
    }
}

}  // namespace

void share_pages(char* begin, std::size_t size) {
    constexpr std::size_t least = std::size_t(1)
                                  << 20;  // smaller arrays share pages with other data (keep_large_arrays_apart)
    const std::span<char> pages = whole_pages({begin, size}, least);
    const int file = pages.empty() ? -1 : file_of_node(pages.size());
    if (file < 0) return;
    move_pages(pages, file, MAP_PRIVATE);
    team.shared_bytes += pages.size();
    close(file);
}

std::span<char> open_in_common(std::span<char> array) {
    constexpr std::size_t least = std::size_t(1) << 17;
    if (team.node_size != static_cast<int>(team.size)) return {};
    const std::span<char> pages = whole_pages(array, least);
    team.common_file = pages.empty() ? -1 : file_of_node(pages.size());
    if (team.common_file < 0) return {};
    move_pages(pages, team.common_file, MAP_SHARED);
    return pages;
}

void close_in_common(std::span<char> pages) {
    map_pages(pages, team.common_file, 0, MAP_PRIVATE);
    team.shared_bytes += pages.size();
    close(std::exchange(team.common_file, -1));
}

}  // namespace detail

}  // namespace exitance
