#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/small_scene.hpp"

namespace exitance::test {

using Json = nlohmann::json;

namespace {

std::string solve_small_room(const TemporaryFolder& folder, const std::string& name,
                             const std::vector<std::string>& more) {
    std::vector<std::string> words{"solve", write_small_room(folder), "-o", folder / (name + ".h5"), "--error", "0.15",
                                   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = run_program(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return run.out;
}

/// All light of a solution, as text.
std::string light_by_schedule(const TemporaryFolder& folder, const std::string& name) {
    const std::string table = folder / (name + ".csv");
    EXPECT_EQ(run_program({"export", folder / (name + ".h5"), "-o", table}).status, 0);
    return read_text(table);
}

}  // namespace

TEST(ProgramSchedule, AllSchedulesGiveTheSameLightAndReportTheirName) {
    const TemporaryFolder folder;
    std::string first;
    for (const std::string schedule : {"static", "dynamic", "stealing"}) {
        const std::string json =
            solve_small_room(folder, schedule, {"--schedule", schedule, "--threads", "3", "--method", "hierarchical"});
        EXPECT_EQ(Json::parse(json)["schedule"], schedule);
        const std::string light = light_by_schedule(folder, schedule);
        if (first.empty()) first = light;
        EXPECT_EQ(light, first);
    }
    EXPECT_EQ(run_program({"solve", "x.obj", "--schedule", "chaotic"}).status, 2);
}

TEST(ProgramTrace, TasksHaveParentsAndDoNotOverlapPerWorker) {
    const TemporaryFolder folder;
    const std::string file = folder / "trace.json";
    const std::vector<std::string> options = {"--threads", "2", "--method", "wavelet", "--epsilon", "0.02"};
    std::vector<std::string> traced = options;
    traced.insert(traced.end(), {"--trace", file});
    solve_small_room(folder, "traced", traced);
    solve_small_room(folder, "plain", options);
    EXPECT_EQ(light_by_schedule(folder, "traced"), light_by_schedule(folder, "plain"));

    const Json trace = Json::parse(read_text(file));
    EXPECT_EQ(trace["otherData"]["schedule"], "stealing");
    std::map<std::uint64_t, Json> by_id;
    std::map<int, std::vector<std::pair<double, double>>> tasks;
    std::set<std::string> names;
    for (const Json& event : trace["traceEvents"]) {
        if (event["ph"] == "M") continue;
        EXPECT_TRUE(by_id.emplace(event["args"]["id"], event).second) << "ids are told apart";
        names.insert(event["name"]);
        const double begin = event["ts"], end = begin + event["dur"].get<double>();
        EXPECT_LE(begin, end);
        if (event["cat"] == "task") tasks[event["tid"]].emplace_back(begin, end);
    }
    for (const char* name : {"direct light", "judge links", "gather links", "interpolate"})
        EXPECT_TRUE(names.count(name)) << name;
    EXPECT_EQ(tasks.size(), 2u);
    const double half_a_nanosecond = 0.0005;  // times are written with a resolution of a nanosecond
    for (auto& [worker, spans] : tasks) {
        std::sort(spans.begin(), spans.end());
        for (std::size_t i = 1; i < spans.size(); ++i)
            ASSERT_LE(spans[i - 1].second, spans[i].first + half_a_nanosecond);
    }
    std::map<std::uint64_t, std::uint64_t> covered;
    for (const auto& [id, event] : by_id) {
        if (event["cat"] == "phase") continue;
        const Json& parent = by_id.at(event["args"]["parent"]);
        EXPECT_EQ(parent["cat"], event["cat"] == "task" ? "loop" : "phase");
        EXPECT_LE(parent["ts"].get<double>(), event["ts"].get<double>());
        if (event["cat"] != "task") continue;
        covered[event["args"]["parent"]] +=
            event["args"]["last"].get<std::uint64_t>() - event["args"]["first"].get<std::uint64_t>();
        if (event["name"] == "judge links") {
            EXPECT_LT(event["args"]["receiver_polygon"], 7);
            EXPECT_LE(event["args"]["first_source_polygon"], event["args"]["last_source_polygon"]);
            EXPECT_GT(event["args"]["bytes"], 0);
        }
    }
    for (const auto& [id, event] : by_id)
        if (event["cat"] == "loop") {
            EXPECT_EQ(covered[id], event["args"]["indices"]) << "tasks make up their loop";
        }
}

TEST(ProgramTrace, AnUnwritableFileEndsBeforeTheWork) {
    const TemporaryFolder folder;
    const Finished run = run_program(
        {"solve", write_small_room(folder), "-o", folder / "room.h5", "--trace", folder / "absent/trace.json"});
    EXPECT_EQ(run.status, 5);
    EXPECT_NE(run.err.find("absent/trace.json"), std::string::npos) << run.err;
    EXPECT_EQ(folder.count(), 2u);
}

}  // namespace exitance::test
