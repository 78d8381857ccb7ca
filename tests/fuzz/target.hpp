#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exitance::fuzz {

/// The files of tests/fuzz/corpus/NAME, sorted by name.
std::vector<std::string> corpus_folder(std::string_view name);

/// A reader to be tested with damaged files.
struct Target {
    std::string_view name;  ///< Name for `exitance-fuzz NAME`.
    /// Reads a file with these bytes. It may reject the file but must not crash.
    void (*read)(const std::string& bytes);
    /// Corrects lengths and checksums after a mutation, so that reading continues beyond them; or null.
    void (*mend)(std::string& bytes) = nullptr;
    /// Returns valid files that together use the whole format; null: those of tests/fuzz/corpus/NAME.
    std::vector<std::string> (*make_corpus)() = nullptr;
    /// For readers that first let a library read a file in a copy of the process: performs that first reading in this
    /// process, where a crash is not the reader's fault. Returns true if the reader would continue. Null for other
    /// readers.
    bool (*rehearse)(const std::string& bytes) = nullptr;
    /// Continues with the file that was rehearsed last.
    void (*read_rehearsed)() = nullptr;

    std::vector<std::string> corpus() const { return make_corpus ? make_corpus() : corpus_folder(name); }
};

/// All targets; the table is in targets.cpp.
std::span<const Target> targets();
const Target* find_target(std::string_view name);

/// Creates a file with these bytes, for readers that need a path. The path is always the same, in a temporary folder of
/// this process, in memory if possible. `name` defines the ending.
std::string file_with(const std::string& bytes, const std::string& name);

}  // namespace exitance::fuzz
