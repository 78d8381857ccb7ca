#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys(const Json& json) {
    std::vector<std::string> names;
    for (const auto& [name, value] : json.items()) names.push_back(name);
    return names;
}

}  // namespace

TEST(ProgramCheck, ASoundSceneIsUsableAndCounted) {
    const TemporaryFolder folder;
    const Finished run = run_program({"check", write_small_room(folder)});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out.find("The scene can be used: 7 surfaces"), std::string::npos) << run.out;
}

TEST(ProgramCheck, JsonHasTheKeysOfTheContract) {
    const TemporaryFolder folder;
    const Json json = Json::parse(run_program({"check", "--json", write_small_room(folder)}).out);
    EXPECT_EQ(keys(json), (std::vector<std::string>{"surfaces", "errors", "warnings", "repairs"}));
    EXPECT_EQ(json["surfaces"], 7);
    EXPECT_TRUE(json["errors"].empty());
}

TEST(ProgramCheck, ABrokenSceneIsBadInputWithFileAndLine) {
    const TemporaryFolder folder;
    const std::string scene = write_broken_scene(folder);
    const Finished run = run_program({"check", scene});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("error: " + scene + ":9: "), std::string::npos) << run.err;

    const Finished as_json = run_program({"check", scene, "--json"});
    EXPECT_EQ(as_json.status, 3);
    const Json json = Json::parse(as_json.out);
    ASSERT_EQ(json["errors"].size(), 1u);
    EXPECT_EQ(keys(json["errors"][0]), (std::vector<std::string>{"file", "line", "message"}));
    EXPECT_EQ(json["errors"][0]["line"], 9);
    EXPECT_EQ(json["errors"][0]["file"], scene);
}

TEST(ProgramCheck, AMissingFileIsBadInput) {
    for (const char* verb : {"check", "solve"}) {
        const TemporaryFolder folder;
        std::vector<std::string> arguments{verb, folder / "absent.obj"};
        if (verb == std::string("solve")) arguments.insert(arguments.end(), {"-o", folder / "s.h5"});
        const Finished run = run_program(arguments);
        EXPECT_EQ(run.status, 3) << verb;
        EXPECT_EQ(run.err.find("error: "), 0u) << run.err;
        EXPECT_NE(run.err.find("absent.obj"), std::string::npos) << run.err;
        EXPECT_EQ(folder.count(), 0u) << "nothing is left behind";
    }
}

}  // namespace exitance::test
