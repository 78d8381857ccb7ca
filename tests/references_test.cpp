#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include "support/places.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST(References, EverySourceNamedInTheCodeHasAnEntry) {
    const fs::path root(test::source_folder());
    const std::string entries = read(root / "docs/references.bib");
    const std::regex key(R"(\[([A-Z][A-Za-z]+[0-9]{2}|CGAL)\])");
    std::size_t found = 0;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(root / "src")) {
        if (!file.is_regular_file()) continue;
        const std::string text = read(file.path());
        for (std::sregex_iterator match(text.begin(), text.end(), key), end; match != end; ++match, ++found)
            EXPECT_NE(entries.find("{" + (*match)[1].str() + ","), std::string::npos)
                << (*match)[0] << " in " << file.path() << " is not in docs/references.bib";
    }
    EXPECT_GT(found, 30u);
}

}  // namespace exitance
