#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>

#include "cli/small_scene.hpp"
#include "exitance/io/export/viewer_data.hpp"
#include "exitance/io/export/viewer_frame.hpp"
#include "exitance/io/export/viewer_part.hpp"
#include "exitance/io/files/base64.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "support/places.hpp"
#include "support/sample_solution.hpp"

namespace exitance::test {
namespace {

bool has_page() {
    return std::filesystem::exists(std::filesystem::path(test::program()).parent_path() / "../viewer/index.html");
}

/// Sends a request to a server on this machine and returns its answer, until the connection is closed.
std::string ask(int port, const std::string& request) {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string out;
    if (connect(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
        send(s, request.data(), request.size(), 0) == static_cast<ssize_t>(request.size())) {
        char part[4096];
        for (ssize_t n = 0; (n = recv(s, part, sizeof part, 0)) > 0;) out.append(part, static_cast<std::size_t>(n));
    }
    close(s);
    return out;
}

/// Returns the whole answer to a request for a path.
std::string ask_for(int port, const std::string& path) {
    return ask(
        port, "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\nConnection: close\r\n\r\n");
}

/// A port that is free at present.
int free_port() {
    const int s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET, address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    bind(s, reinterpret_cast<const sockaddr*>(&address), size);
    getsockname(s, reinterpret_cast<sockaddr*>(&address), &size);
    close(s);
    return ntohs(address.sin_port);
}

}  // namespace

/// A part, decoded as the page decodes it.
struct ReadPart {
    explicit ReadPart(const std::string& bytes) {
        std::uint32_t counts[2];
        std::memcpy(counts, bytes.data() + 4, sizeof counts);
        positions.resize(std::size_t{3} * counts[0]), light.resize(positions.size());
        faces.resize(std::size_t{5} * counts[1]);
        const std::size_t bytes_of_vertices = 4 * positions.size();
        whole = bytes.starts_with("EXV2") && bytes.size() == 12 + 2 * bytes_of_vertices + 4 * faces.size();
        if (!whole) return;
        std::memcpy(positions.data(), bytes.data() + 12, bytes_of_vertices);
        std::memcpy(light.data(), bytes.data() + 12 + bytes_of_vertices, bytes_of_vertices);
        std::memcpy(faces.data(), bytes.data() + 12 + 2 * bytes_of_vertices, 4 * faces.size());
    }
    bool whole = false;
    std::vector<float> positions, light;
    std::vector<std::uint32_t> faces;
};

TEST(ViewerData, APartHoldsAllElementsAndTheirLight) {
    const Solution solution = sample_solution();
    ASSERT_EQ(viewer_part_count(solution, ViewerLayer::exported), 1u);
    const std::string bytes = viewer_part(solution, ViewerLayer::exported, 0);
    const ReadPart part(bytes);
    ASSERT_TRUE(part.whole);
    // The faces cover the same area as the leaves.
    const auto at = [&](std::size_t i) {
        return Point{part.positions[3 * i], part.positions[3 * i + 1], part.positions[3 * i + 2]};
    };
    double area = 0, leaves = 0;
    std::size_t first = 0;
    for (std::size_t f = 0; f < part.faces.size(); f += 5) {
        const std::size_t shape = part.faces[f], corners = shape == 262 ? 3 : shape;
        for (std::size_t i = 1; i + 1 < corners; ++i)
            area += 0.5 * norm(cross(at(first + i) - at(first), at(first + i + 1) - at(first)));
        first += shape & 255;
    }
    EXPECT_EQ(3 * first, part.positions.size());
    for (const ElementId leaf : solution.interpolant.tree.leaves()) leaves += solution.interpolant.tree.area(leaf);
    EXPECT_NEAR(area, leaves, 1e-5 * leaves);
    // The light without geometry is the same.
    const std::string alone = viewer_part_light(solution, ViewerLayer::exported, 0);
    ASSERT_TRUE(alone.starts_with("EXL1"));
    EXPECT_EQ(alone.substr(8), bytes.substr(12 + 4 * part.positions.size(), 4 * part.light.size()));
}

TEST(ViewerData, RawElementsOfAConstantBasisHaveOneValueWithDirectLightAtTheirCentres) {
    Solution solution = sample_solution();
    solution.statistics.basis = "constant";
    const RadiosityFunction light(solution);
    const ReadPart part(viewer_part(solution, ViewerLayer::raw, 0, &light));
    ASSERT_TRUE(part.whole);
    std::size_t first = 0, checked = 0;
    double brightest = 0;
    for (std::size_t f = 0; f < part.faces.size(); f += 5) {
        const std::size_t corners = part.faces[f];
        const ElementId e{part.faces[f + 2]};
        Point centre;
        for (std::size_t i = 0; i < corners; ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_EQ(part.light[3 * (first + i) + c], part.light[3 * first + c]) << "face " << f / 5;
            const float* p = part.positions.data() + 3 * (first + i);
            centre = centre + (1.0 / static_cast<double>(corners)) * Vec3{p[0], p[1], p[2]};
        }
        const Normal n = solution.scene.regions()[solution.indirect.tree.region(e)].plane.n;
        const ProbePoint point{centre, n};
        const double direct = light.at(std::span(&point, 1), Component::direct)[0].irradiance[0];
        double reflected = 0;
        for (const Vec2 uv : solution.indirect.tree.domain(e))
            reflected += solution.indirect.at({e, uv})[0] / static_cast<double>(corners);
        EXPECT_NEAR(part.light[3 * first], reflected + light.exact_share()[0] * direct,
                    1e-4 * (1 + reflected + direct));
        brightest = std::max(brightest, direct);
        first += corners, ++checked;
    }
    EXPECT_EQ(checked, solution.indirect.tree.leaves().size());
    EXPECT_GT(brightest, 0);
}

TEST(ViewerData, AFrameHoldsThePictureFromTheBottomUp) {
    const Solution solution = sample_solution();
    const RadiosityFunction light(solution);
    Progress quiet;
    PictureOptions options;
    options.camera = {{0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, 70}, options.size = {7, 5};
    const Picture picture = take_picture(light, options, quiet, StopRequest());
    for (const bool photometric : {false, true}) {
        const LightUnit own = own_unit(photometric);
        const std::string frame = viewer_frame(picture, own);
        ASSERT_EQ(frame.size(), 12 + 4u * 6 * 35);
        ASSERT_TRUE(frame.starts_with("EXF1"));
        std::vector<float> numbers(6 * 35);
        std::memcpy(numbers.data(), frame.data() + 12, 4 * numbers.size());
        const Pixel& lowest = picture.pixels[28];
        EXPECT_GT(lowest.front, 0);
        EXPECT_EQ(numbers[0], static_cast<float>(lowest.radiosity[0]));
        EXPECT_EQ(numbers[3], lowest.front);
        EXPECT_EQ(numbers[4 * 35], static_cast<float>(own(lowest.irradiance)));
    }
}

TEST(ViewerData, HasTheWeightsOfColoursInTheScenesUnit) {
    if constexpr (bands != 3) GTEST_SKIP() << "the bands of this build weigh alike";
    const Camera camera{{0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, 70};
    const auto facts = [&](bool photometric, UnitChoice choice) {
        return viewer_scene_json(sample_solution(40, photometric), camera, LightUnit(choice, photometric));
    };
    EXPECT_NE(facts(true, UnitChoice::scene).find("\"weights\":[0.265,0.67,0.065]"), std::string::npos);
    EXPECT_NE(facts(false, UnitChoice::scene).find("\"weights\":[0.333"), std::string::npos);
    EXPECT_NE(facts(false, UnitChoice::scene).find("\"lux\":false"), std::string::npos);
    // In lux, light in watts is multiplied by 179 lm/W, too.
    EXPECT_NE(facts(false, UnitChoice::lux).find("\"weights\":[47.43"), std::string::npos)
        << facts(false, UnitChoice::lux);
    EXPECT_NE(facts(false, UnitChoice::lux).find("\"lux\":true"), std::string::npos);
}

TEST(ProgramView, AnswersItsOwnPageAndNobodyElse) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    const int port = free_port();
    RunningProgram run({"view", folder / "s.h5", "--port", std::to_string(port)});
    ASSERT_TRUE(run.wait_for("ends the viewer"));
    const std::string host = "Host: 127.0.0.1:" + std::to_string(port) + "\r\nConnection: close\r\n";
    const auto get = [&](const std::string& path, const std::string& headers) {
        return ask(port, "GET " + path + " HTTP/1.1\r\n" + headers + "\r\n").substr(0, 12);
    };
    EXPECT_EQ(get("/", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/scene", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/part?layer=exported&part=0", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/part?layer=exported&part=7", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/part?layer=exported&part=nan", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/part?layer=raw&part=0", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/part?layer=raw&part=0&only=light", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/frame?camera=0.1,0.1,0.5,1.5,0.5,0.5,70&size=16,10&samples=1", host), "HTTP/1.1 200");
    EXPECT_EQ(get("/data/frame?camera=0.1,0.1,0.5,0.1,0.1,0.5,70&size=16,10&samples=1", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/frame?camera=0.1,0.1,0.5,1.5,0.5,0.5,70&size=1e6,1e6&samples=1", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/point?at=1,2", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/line?at=0,0,0,1,1,1,0,0,0", host), "HTTP/1.1 400");
    // Nothing is compressed, which would take longer than the transfer.
    const std::string plain = ask(port, "GET / HTTP/1.1\r\n" + host + "Accept-Encoding: gzip, br\r\n\r\n");
    EXPECT_EQ(plain.find("Content-Encoding"), std::string::npos);
    EXPECT_NE(plain.find("</html>"), std::string::npos);
    EXPECT_EQ(get("/../../../../etc/passwd", host), "HTTP/1.1 404");
    EXPECT_EQ(get("/%2e%2e/%2e%2e/etc/passwd", host), "HTTP/1.1 404");
    EXPECT_EQ(get("/data/scene", host + "Origin: http://example.org\r\n"), "HTTP/1.1 403");
    EXPECT_EQ(get("/data/scene", host + "Sec-Fetch-Site: cross-site\r\n"), "HTTP/1.1 403");
    EXPECT_EQ(get("/data/scene", "Host: example.org\r\nConnection: close\r\n"), "HTTP/1.1 403");
    const Finished second = run_program({"view", folder / "s.h5", "--port", std::to_string(port)});
    EXPECT_EQ(second.status, 1);
    EXPECT_NE(second.err.find("is in use"), std::string::npos) << second.err;
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
}

TEST(ProgramView, ASceneIsReadInItsLengthUnitAndUprightAxis) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    const std::string scene = write_small_room_in(folder, 1000, true, "mm");
    const int port = free_port();
    RunningProgram run(
        {"view", scene, "--length-unit", "mm", "--up", "y", "--error", "0.3", "--port", std::to_string(port)});
    ASSERT_TRUE(run.wait_for("ends the viewer"));
    const auto get = [&](const std::string& path) {
        const std::string answer = ask_for(port, path);
        const std::size_t body = answer.find("\r\n\r\n");
        return body == std::string::npos || !answer.starts_with("HTTP/1.1 200") ? "" : answer.substr(body + 4);
    };
    std::string part;
    for (int tries = 0; part.empty() && tries < 600; ++tries) {
        part = get("/data/part?layer=exported&part=0");
        if (part.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    const ReadPart read(part);
    ASSERT_TRUE(read.whole);
    std::array<float, 3> lo{1e9f, 1e9f, 1e9f}, hi{-1e9f, -1e9f, -1e9f};
    for (std::size_t i = 0; i < read.positions.size(); ++i) {
        lo[i % 3] = std::min(lo[i % 3], read.positions[i]);
        hi[i % 3] = std::max(hi[i % 3], read.positions[i]);
    }
    EXPECT_NEAR(hi[0] - lo[0], 4, 1e-5);
    EXPECT_NEAR(hi[1] - lo[1], 3, 1e-5);
    EXPECT_NEAR(hi[2] - lo[2], 2.5, 1e-5);
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    EXPECT_EQ(run_program({"view", folder / "s.h5", "--length-unit", "mm"}).status, 2);
}

TEST(ProgramView, SolvesASceneUnderASkyWithLightGroupsInLux) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const int port = free_port();
    RunningProgram run({"view", scene, "--sky", "uniform,dhi=50", "--light-groups", "--unit", "lux", "--error", "0.3",
                        "--port", std::to_string(port)});
    ASSERT_TRUE(run.wait_for("ends the viewer"));
    const auto get = [&](const std::string& path) { return ask_for(port, path); };
    std::string groups;
    for (int tries = 0; groups.find("lamp") == groups.npos && tries < 600; ++tries) {
        groups = get("/groups");
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_NE(groups.find("\"lamp\""), std::string::npos) << groups;
    EXPECT_NE(groups.find("sky"), std::string::npos) << groups;
    EXPECT_NE(get("/data/scene").find("\"lux\":true"), std::string::npos);
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    EXPECT_EQ(run_program({"view", folder / "s.h5", "--sky", "uniform,dhi=50"}).status, 2);
    EXPECT_EQ(run_program({"view", scene, "--light-groups", "--method", "discontinuity"}).status, 2);
    EXPECT_NE(run_program({"view", folder / "s.h5", folder / "s.h5", folder / "s.h5"}).err.find("one solution"),
              std::string::npos);
}

TEST(ProgramView, DimsAndPaintsAsMixDoes) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    ASSERT_EQ(run_program({"solve", scene, "-o", folder / "s.h5", "--error", "0.1", "--light-groups", "-q"}).status, 0);
    ASSERT_EQ(run_program({"mix", folder / "s.h5", "lamp=0.3", "--reflectance", "grey=0.8,0.6,0.5", "-o",
                           folder / "m.h5", "-q"})
                  .status,
              0);
    const Result<Solution> mixed = load_solution(folder / "m.h5");
    ASSERT_TRUE(mixed);
    const int port = free_port();
    RunningProgram run({"view", folder / "s.h5", "--port", std::to_string(port)});
    ASSERT_TRUE(run.wait_for("ends the viewer"));
    const std::string answer =
        ask(port,
            "GET /data/part?layer=exported&part=0&only=light&dim=lamp:0.3&paint=grey:0.8/0.6/0.5 HTTP/1.1\r\nHost: "
            "127.0.0.1:" +
                std::to_string(port) + "\r\nConnection: close\r\n\r\n");
    const std::size_t body = answer.find("\r\n\r\n");
    ASSERT_NE(body, std::string::npos);
    EXPECT_EQ(answer.substr(body + 4), viewer_part_light(*mixed, ViewerLayer::exported, 0));
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
}

TEST(ProgramView, ComparesTwoSolutionsOfOneRoomInOneUnit) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "a.h5", sample_solution(40)));
    ASSERT_TRUE(write_solution(folder / "b.h5", sample_solution(80)));
    ASSERT_TRUE(write_solution(folder / "lux.h5", sample_solution(40, true)));
    const std::string scene = write_small_room(folder);
    ASSERT_EQ(run_program({"solve", scene, "-o", folder / "room.h5", "--error", "0.3", "-q"}).status, 0);
    const int port = free_port();
    RunningProgram run({"view", folder / "a.h5", folder / "b.h5", "--port", std::to_string(port)});
    ASSERT_TRUE(run.wait_for("ends the viewer"));
    const auto get = [&](const std::string& path) {
        const std::string answer = ask_for(port, path);
        return answer.substr(answer.find("\r\n\r\n") + 4);
    };
    EXPECT_NE(get("/data/state").find("b.h5"), std::string::npos);
    EXPECT_EQ(get("/data/part?layer=exported&part=0&of=other"),
              viewer_part(sample_solution(80), ViewerLayer::exported, 0));
    EXPECT_EQ(get("/data/part?layer=exported&part=0"), viewer_part(sample_solution(40), ViewerLayer::exported, 0));
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
    const Finished unit = run_program({"view", folder / "a.h5", folder / "lux.h5"});
    EXPECT_EQ(unit.status, 2);
    EXPECT_NE(unit.err.find("another unit"), std::string::npos) << unit.err;
    const Finished room = run_program({"view", folder / "a.h5", folder / "room.h5"});
    EXPECT_EQ(room.status, 2);
    EXPECT_NE(room.err.find("is of another scene"), std::string::npos) << room.err;
}

TEST(ProgramView, WritesAPageThatHoldsItsData) {
    if (!has_page()) GTEST_SKIP() << "the viewer's page was not built";
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    write_text(folder / "views.json", R"([{"name": "</script>", "camera": "1,1,1 2,2,1 60"}])");
    const Finished run =
        run_program({"view", folder / "s.h5", "-o", folder / "s.html", "--views", folder / "views.json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string page = read_text(folder / "s.html");
    EXPECT_EQ(page.find("src=\"/"), std::string::npos);
    EXPECT_EQ(page.find("href=\"/"), std::string::npos);
    EXPECT_NE(page.find(R"(id="shared">{"state":null,"views":[{"camera":"1,1,1 2,2,1 60","name":"<\/script>"}])"),
              std::string::npos);
    const std::string part = viewer_part(sample_solution(), ViewerLayer::exported, 0);
    EXPECT_NE(page.find(base64(std::as_bytes(std::span(part)))), std::string::npos);
    EXPECT_EQ(run_program({"view", folder / "s.h5", "-o", folder / "s.png"}).status, 2);
    EXPECT_EQ(run_program({"view", folder / "s.h5", "--views", folder / "views.json"}).status, 2);
    EXPECT_EQ(run_program({"view", folder / "s.h5", folder / "s.h5", "-o", folder / "s.html"}).status, 2);
    write_text(folder / "views.json", R"([{"name": 1}])");
    EXPECT_EQ(run_program({"view", folder / "s.h5", "-o", folder / "s.html", "--views", folder / "views.json"}).status,
              3);
}

TEST(ProgramRender, RendersNumberedPicturesAlongAPath) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    write_text(folder / "p.csv", "time,ex,ey,ez,tx,ty,tz,fov\n0,-1,1,1,2,2,1,60\n1,-2,1,1,2,2,1,60\n");
    const std::vector<std::string> words{"render", folder / "s.h5", "-o",    folder / "w.png",
                                         "--size", "16x10",         "--path"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), words.begin(), words.end());
        return run_program(more);
    };
    const Finished run = with({folder / "p.csv"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(read_text(folder / "w.0001.png").starts_with("\x89PNG"));
    EXPECT_TRUE(read_text(folder / "w.0002.png").starts_with("\x89PNG"));
    EXPECT_FALSE(std::filesystem::exists(folder / "w.0003.png"));
    EXPECT_EQ(with({folder / "p.csv", "--camera", "1,1,1 2,2,2 60"}).status, 2);
    EXPECT_EQ(with({folder / "p.csv", "--isolux"}).status, 2);
    write_text(folder / "bad.csv", "time,ex,ey,ez,tx,ty,tz,fov\n0,-1,1,1,2,2,60\n");
    EXPECT_EQ(with({folder / "bad.csv"}).status, 3);
}

TEST(ProgramRender, MakesAVideoByFfmpegAndSaysWhereThatIsMissing) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    // Keyframes at unequal times: 0.24 s at 25 pictures per second are 7 pictures.
    write_text(folder / "p.csv", "0,-1,1,1,2,2,1,60\n0.2,-2,1,1,2,2,1,60\n0.24,-3,1,1,2,2,1,60\n");
    // A fake ffmpeg, which counts the pictures and writes its last argument, the video.
    write_text(folder / "ffmpeg",
               "#!/bin/bash\nfor last; do :; done\nfor ((i = 1; i <= $#; ++i)); do [[ ${!i} == -i ]] && j=$((i + 1)); "
               "done\nset -- \"${!j%/*}\"/frame.*.png\necho \"$# pictures\" >\"$last\"\n[[ $1 != *.0001.png ]]; exit "
               "$((1 - $?))\n");
    std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms::owner_all);
    const std::string path = getenv("PATH");
    const auto with = [&](const std::string& search, const std::string& output, const std::string& cameras) {
        setenv("PATH", search.c_str(), 1);
        const Finished run = run_program({"render", folder / "s.h5", "-o", folder / output, "--size", "16x10",
                                          "--samples", "1", "--path", folder / cameras});
        setenv("PATH", path.c_str(), 1);
        return run;
    };
    const Finished missing = with("/nowhere", "w.mp4", "p.csv");
    EXPECT_EQ(missing.status, 5);
    EXPECT_NE(missing.err.find("ffmpeg, which is not installed"), std::string::npos) << missing.err;
    const std::string search = std::filesystem::path(folder / "ffmpeg").parent_path().string() + ":" + path;
    const Finished run = with(search, "w.mp4", "p.csv");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(read_text(folder / "w.mp4"), "7 pictures\n");
    write_text(folder / "falls.csv", "1,-1,1,1,2,2,1,60\n0.2,-2,1,1,2,2,1,60\n");
    EXPECT_EQ(with(search, "v.mp4", "falls.csv").status, 3);
    write_text(folder / "long.csv", "0,-1,1,1,2,2,1,60\n1e9,-2,1,1,2,2,1,60\n");
    EXPECT_EQ(with(search, "v.mp4", "long.csv").status, 3);
    EXPECT_EQ(run_program({"render", folder / "s.h5", "-o", folder / "w.mp4"}).status, 2);
    write_text(folder / "ffmpeg", "#!/bin/bash\necho no such codec >&2\nexit 1\n");
    const Finished failed = with(search, "u.mp4", "p.csv");
    EXPECT_EQ(failed.status, 5);
    EXPECT_NE(failed.err.find("no such codec"), std::string::npos) << failed.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "u.mp4"));
}

TEST(ProgramHelp, MakesAManualPageAndACompletionOfItsOptions) {
    const Finished man = run_program({"--man"}), completion = run_program({"--completion", "bash"});
    EXPECT_EQ(man.status, 0);
    EXPECT_TRUE(man.out.starts_with(".TH EXITANCE 1"));
    EXPECT_NE(man.out.find(".SH viewfactors"), std::string::npos);
    EXPECT_NE(man.out.find("\\-\\-keep\\-links"), std::string::npos);
    EXPECT_EQ(completion.status, 0);
    EXPECT_EQ(run_program({"--completion", "cobol"}).status, 2);
    const TemporaryFolder folder;
    write_text(
        folder / "c.sh",
        completion.out + "COMP_WORDS=(exitance render --pa) COMP_CWORD=2\n_exitance\necho \"${COMPREPLY[@]}\"\n");
    EXPECT_EQ(RunningProgram({folder / "c.sh"}, {}, "/bin/bash").finish().out, "--path --palette\n");
}

}  // namespace exitance::test
