// Runs the cases of CIE 171: exitance-cie171 FOLDER [--quick] [--only 5.8]. Prints one line per case.
#include <cstdio>
#include <string>

#include "exitance/lab/studies/cie171.hpp"

int main(int argc, char** argv) {
    using namespace exitance;
    Cie171Options options;
    std::string folder;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--quick")
            options.quick = true;
        else if (word == "--only" && i + 1 < argc)
            options.only = argv[++i];
        else
            folder = word;
    }
    if (folder.empty()) {
        std::fprintf(stderr, "exitance-cie171 FOLDER [--quick] [--only CASE]\n");
        return 2;
    }
    Progress progress;
    const Result<std::vector<Cie171Row>> rows = run_cie171(options, progress, StopRequest());
    if (!rows) {
        std::fprintf(stderr, "error: %s\n", rows.error().message.c_str());
        return 1;
    }
    if (const Result<void> written = write_cie171(folder, *rows); !written) {
        std::fprintf(stderr, "error: %s\n", written.error().message.c_str());
        return 5;
    }
    for (const Cie171Summary& s : summarize(*rows))
        std::printf("%-5s %4zu points  mean %.1e  largest %.1e  (%s)\n", s.study.c_str(), s.points, s.mean, s.largest,
                    s.worst.c_str());
    return 0;
}
