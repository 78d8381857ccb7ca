#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// Columns 0 and 6 of the table: the receivers, and the sum of the form factors.
std::pair<std::vector<std::string>, double> receivers_and_sum(const std::string& path) {
    std::istringstream lines(read_text(path));
    std::pair<std::vector<std::string>, double> out;
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line.substr(0, 16), "receiver,source,");
    while (std::getline(lines, line)) {
        std::istringstream fields(line);
        std::string field;
        for (int i = 0; i < 7 && std::getline(fields, field, ','); ++i)
            if (i == 0) out.first.push_back(field);
        out.second += std::stod(field);
    }
    return out;
}

}  // namespace

TEST(ProgramLinks, OfAPointCoverAllThatIsVisible) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), table = folder / "links.csv", lines = folder / "links.obj";
    for (const std::string method : {"hierarchical", "wavelet"}) {
        const std::string solution = folder / (method + ".h5");
        const Finished run = run_program(
            {"solve", scene, "-o", solution, "--method", method, "--error", "0.1", "--keep-links", "--json"});
        ASSERT_EQ(run.status, 0) << run.err;
        const auto json = nlohmann::json::parse(run.out);
        EXPECT_GT(json["bytes_per_link"], 0);
        EXPECT_GT(json["bytes_per_element"], 0);
        EXPECT_EQ(json["elements_by_level"][0], 7) << "roots: the faces";

        ASSERT_EQ(run_program({"export", solution, "--links", "0.5,0.4,0", "-o", table}).status, 0);
        const auto [receivers, sum] = receivers_and_sum(table);
        // In a closed room form factors sum to 1, except for the black lamp, to which there are no links: at most 0.1
        // of the hemisphere.
        EXPECT_GT(sum, 0.85) << method;
        EXPECT_LT(sum, 1.03) << method;
        ASSERT_EQ(run_program({"export", solution, "--links", receivers.front(), "-o", lines}).status, 0);
        const std::string drawn = read_text(lines);
        EXPECT_NE(drawn.find("o receiver_" + receivers.front() + "\n"), std::string::npos);
        EXPECT_NE(drawn.find("\nl "), std::string::npos);
        const std::string glb = folder / "links.glb";
        ASSERT_EQ(run_program({"export", solution, "--links", receivers.front(), "-o", glb}).status, 0);
        const std::string bytes = read_text(glb);
        const auto of_json = static_cast<std::size_t>(static_cast<unsigned char>(bytes[12])) +
                             256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes[13]));
        const auto scene_of_lines = nlohmann::json::parse(bytes.substr(20, of_json));
        ASSERT_EQ(scene_of_lines["meshes"].size(), 3u);  // receivers, sources, links
        for (const auto& mesh : scene_of_lines["meshes"]) EXPECT_EQ(mesh["primitives"][0]["mode"], 1) << "lines";
        std::size_t drawn_lines = 0;
        for (std::size_t at = 0; (at = drawn.find("\nl ", at)) != std::string::npos; ++at) ++drawn_lines;
        EXPECT_EQ(scene_of_lines["accessors"][2]["count"], 2 * drawn_lines) << method;
        EXPECT_EQ(run_program({"export", solution, "--links", "99999999", "-o", table}).status, 2);
        EXPECT_EQ(run_program({"export", solution, "--links", "lamp", "-o", table}).status, 2);
    }
    const std::string without = folder / "without.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", without, "--method", "hierarchical", "--error", "0.2"}).status, 0);
    const Finished refused = run_program({"export", without, "--links", "3", "-o", table});
    EXPECT_EQ(refused.status, 3);
    EXPECT_NE(refused.err.find("--keep-links"), std::string::npos) << refused.err;
}

}  // namespace exitance::test
