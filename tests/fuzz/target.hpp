#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exitance::fuzz {

/// The files of tests/fuzz/corpus/NAME, in the order of their names.
std::vector<std::string> corpus_folder(std::string_view name);

/// A reader under attack: files to begin with, and what is done with a damaged one.
struct Target {
    std::string_view name;                   ///< As `exitance-fuzz NAME` takes it.
    void (*read)(const std::string& bytes);  ///< Reads a file of these bytes; may find it bad, and nothing worse.
    /// Makes lengths and checksums fit again after a mutation, so that what stands behind them is reached; or null.
    void (*mend)(std::string& bytes) = nullptr;
    /// Good files that between them use all of the format; null: those of tests/fuzz/corpus/NAME.
    std::vector<std::string> (*make_corpus)() = nullptr;
    /// For a reader that lets a library read a file in a copy of the process first: that first reading, in this very
    /// process. Whatever happens in it is no fault of the reader's. Returns whether the reader would go on; null: it
    /// needs no such thing.
    bool (*rehearse)(const std::string& bytes) = nullptr;
    /// What follows it: reads the file that was rehearsed last.
    void (*read_rehearsed)() = nullptr;

    std::vector<std::string> corpus() const { return make_corpus ? make_corpus() : corpus_folder(name); }
};

/// All of them; the one table, in targets.cpp.
std::span<const Target> targets();
const Target* find_target(std::string_view name);

/// A new file that holds the bytes, for readers that take a path. The same path every time, in a folder of this process
/// alone, which goes with it and lies in memory where the system has such a place; `name` decides the ending.
std::string file_with(const std::string& bytes, const std::string& name);

}  // namespace exitance::fuzz
