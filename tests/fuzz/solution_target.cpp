#include "fuzz/solution_target.hpp"

#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/evaluate/surface_light.hpp"
#include "exitance/io/solution/hdf5_checksum.hpp"
#include "exitance/io/solution/hdf5_rehearsal.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "fuzz/target.hpp"
#include "support/sample_solution.hpp"

namespace exitance::fuzz {
namespace {

std::uint64_t number_at(const std::string& bytes, std::size_t at, std::size_t length) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < length; ++k) value |= std::uint64_t(static_cast<unsigned char>(bytes[at + k])) << 8 * k;
    return value;
}

struct Range {
    std::size_t begin, end;
};

/// The message ranges of all object headers in a file.
std::vector<Range> headers_in(const std::string& bytes) {
    std::vector<Range> out;
    for (std::size_t at = bytes.find("OHDR"); at != bytes.npos && at + 16 < bytes.size();
         at = bytes.find("OHDR", at + 4)) {
        const auto flags = static_cast<unsigned char>(bytes[at + 5]);
        const std::size_t before = at + 6 + (flags & 0x20 ? 16 : 0) + (flags & 0x10 ? 4 : 0);
        const std::size_t wide = std::size_t(1) << (flags & 3), first = before + wide;
        const std::uint64_t size = number_at(bytes, before, wide);
        if (first + size + 4 <= bytes.size()) out.push_back({at, first + size});
    }
    return out;
}

/// The ranges of values of small data sets, which are in object headers, in the message "layout" of class "compact".
std::vector<Range> values_in(const std::string& bytes) {
    std::vector<Range> out;
    for (const Range& header : headers_in(bytes))
        for (std::size_t at = header.begin + 7; at + 8 < header.end; ++at) {
            const std::uint64_t size = number_at(bytes, at + 1, 2), held = number_at(bytes, at + 6, 2);
            const bool version = bytes[at + 4] == 3 || bytes[at + 4] == 4;
            if (bytes[at] != 8 || !version || bytes[at + 5] != 0 || held == 0 || held + 4 > size || held + 12 < size)
                continue;
            if (at + 8 + held <= header.end) out.push_back({at + 8, at + 8 + held});
        }
    return out;
}

void put_checksum(std::string& bytes, std::size_t from, std::size_t to) {
    const std::uint32_t sum = hdf5_checksum(std::string_view(bytes).substr(from, to - from));
    for (std::size_t k = 0; k < 4; ++k) bytes[to + k] = static_cast<char>(sum >> 8 * k & 0xff);
}

void use(const Result<Solution>& solution) {
    if (!solution) return;
    const std::array<ProbePoint, 2> points{{{{0.5, 0.5, 0}, {0, 0, 1}}, {{0.5, 0.5, 0.5}, {1, 0, 0}}}};
    (void)RadiosityFunction(*solution).at(points);
    (void)mean_light(*solution);
}

std::string& rehearsed_path() {
    static std::string path;
    return path;
}

}  // namespace

std::vector<std::string> solution_corpus() {
    std::vector<std::string> out;
    for (const int cuts : {3, 60}) {
        Solution solution = sample_solution(cuts);
        if (cuts == 3) solution.options.clear(), solution.statistics.warnings.clear();
        if (cuts == 60) {
            solution.statistics.elements_by_level = {12, 40, 71};
            solution.links.elements = solution.indirect;
            for (const ElementId e : solution.indirect.tree.leaves())
                solution.links.links.push_back({e, solution.indirect.tree.leaves().front(), 0.25f});
        }
        const std::string path = file_with("", "corpus.h5");
        if (!write_solution(path, solution)) continue;
        std::ifstream in(path, std::ios::binary);
        out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return out;
}

void mend_solution(std::string& bytes) {
    for (const Range& header : headers_in(bytes)) put_checksum(bytes, header.begin, header.end);
}

void read_solution_bytes(const std::string& bytes) {
    use(load_solution(file_with(bytes, "s.h5")));
}

bool rehearse_solution_bytes(const std::string& bytes) {
    return read_all_of_hdf5(rehearsed_path() = file_with(bytes, "s.h5"), bytes.size());
}

void read_rehearsed_solution() {
    use(load_solution(rehearsed_path(), Rehearsed::already));
}

std::vector<std::string> value_corpus() {
    return {std::string("\x10\x27\x00\x00\x01", 5), std::string(40, '\x03'), "values of a solution, five bytes each"};
}

namespace {

/// Makes the solution that a script defines.
std::string with_values(const std::string& script) {
    static const std::vector<std::string> good = solution_corpus();
    static const std::vector<std::vector<Range>> values = {values_in(good.at(0)), values_in(good.at(1))};
    if (script.size() < 5) return {};
    const std::size_t which = static_cast<unsigned char>(script[0]) & 1;
    std::string bytes = good[which];
    for (std::size_t i = 0; i + 5 <= script.size() && i < 40; i += 5) {
        const std::uint64_t place = number_at(script, i, 3);
        const Range& range = values[which][place % values[which].size()];
        const std::size_t at = range.begin + place / values[which].size() % (range.end - range.begin);
        const auto kind = static_cast<unsigned char>(script[i + 3]);
        // Either a given byte, or NaN, infinity, a huge number, the largest integer, or 0.
        static const std::array<std::string, 5> special = {
            std::string("\0\0\0\0\0\0\xf8\x7f", 8), std::string("\0\0\0\0\0\0\xf0\x7f", 8),
            std::string("\0\0\0\0\0\0\x50\x7e", 8), std::string("\xff\xff\xff\xff", 4), std::string(8, '\0')};
        std::string written(1, script[i + 4]);
        if (kind & 1) written = special[kind / 2 % special.size()];
        const std::size_t aligned = kind & 1 ? at - (at - range.begin) % written.size() : at;
        for (std::size_t k = 0; k < written.size() && aligned + k < range.end; ++k) bytes[aligned + k] = written[k];
    }
    mend_solution(bytes);
    return bytes;
}

}  // namespace

void read_solution_with_values(const std::string& script) {
    read_solution_bytes(with_values(script));
}

bool rehearse_solution_with_values(const std::string& script) {
    return rehearse_solution_bytes(with_values(script));
}

}  // namespace exitance::fuzz
