// exitance-fuzz READER [--seconds N] [--rounds N] [--seed N] [FILE...]
//
// Gives a reader damaged files until the time is over, or the named files. Ends with status 1 and the file's path if a
// file makes the reader crash, use more than 5 s of processor time, or request more memory at a time than 64 MiB plus
// ten times the file's size. The same limit applies to the memory of a process copy in which a reader tries a file
// first. The faulty file is left in the working folder.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "fuzz/attack.hpp"
#include "fuzz/target.hpp"

namespace exitance::fuzz {
namespace {

int usage() {
    std::fprintf(stderr, "exitance-fuzz READER [--seconds N] [--rounds N] [--seed N] [FILE...]\nreaders:");
    for (const Target& target : targets()) std::fprintf(stderr, " %s", std::string(target.name).c_str());
    std::fprintf(stderr, "\n");
    return 2;
}

int run(int count, char** words) {
    const Target* target = count > 1 ? find_target(words[1]) : nullptr;
    if (!target) return usage();
    AttackOptions options;
    std::vector<std::string> files;
    for (int i = 2; i < count; ++i) {
        const std::string word = words[i];
        if (word.rfind("--", 0) != 0) {
            files.push_back(word);
            continue;
        }
        if (i + 1 == count) return usage();
        if (word == "--seconds")
            options.seconds = std::atof(words[++i]);
        else if (word == "--rounds")
            options.rounds = std::strtoull(words[++i], nullptr, 10);
        else if (word == "--seed")
            options.seed = std::strtoull(words[++i], nullptr, 10);
        else
            return usage();
    }
    set_threads(1);
    watch_signals();
    for (const std::string& file : files) {
        read_file_watched(*target, file);
        std::printf("%s: read\n", file.c_str());
    }
    if (files.empty()) attack(*target, options);
    return 0;
}

}  // namespace
}  // namespace exitance::fuzz

int main(int count, char** words) {
    try {
        return exitance::fuzz::run(count, words);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "throws %s\n", e.what());
        exitance::fuzz::end_with_fault();
    }
}
