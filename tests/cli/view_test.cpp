#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstring>

#include "cli/small_scene.hpp"
#include "exitance/io/export/viewer_data.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "support/sample_solution.hpp"

namespace exitance::test {
namespace {

bool has_page() {
    return std::filesystem::exists(std::filesystem::path(EXITANCE_PROGRAM).parent_path() / "../viewer/index.html");
}

/// What a server on this machine answers to a request, to the end of the connection.
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

/// One that nobody listens on at present.
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

TEST(ViewerData, APartHoldsAllElementsAndTheirLight) {
    const Solution solution = sample_solution();
    ASSERT_EQ(viewer_part_count(solution, ViewerLayer::exported), 1u);
    const std::string part = viewer_part(solution, ViewerLayer::exported, 0);
    ASSERT_TRUE(part.starts_with("EXV1"));
    std::uint32_t counts[3];
    std::memcpy(counts, part.data() + 4, sizeof counts);
    const auto [v, t, e] = counts;
    EXPECT_EQ(part.size(), 16 + std::size_t{4} * (3 * v + 3 * v + v + v + 3 * t + 2 * e + e));
    // The triangles cover what the leaves cover.
    std::vector<float> p(3 * v);
    std::vector<std::uint32_t> corners(3 * t);
    std::memcpy(p.data(), part.data() + 16, 4 * p.size());
    std::memcpy(corners.data(), part.data() + 16 + 4 * 8 * std::size_t{v}, 4 * corners.size());
    const auto at = [&](std::uint32_t i) { return Point{p[3 * i], p[3 * i + 1], p[3 * i + 2]}; };
    double area = 0, leaves = 0;
    for (std::size_t i = 0; i < t; ++i)
        area +=
            0.5 * norm(cross(at(corners[3 * i + 1]) - at(corners[3 * i]), at(corners[3 * i + 2]) - at(corners[3 * i])));
    for (const ElementId leaf : solution.interpolant.tree.leaves()) leaves += solution.interpolant.tree.area(leaf);
    EXPECT_NEAR(area, leaves, 1e-5 * leaves);
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
    EXPECT_EQ(get("/data/point?at=1,2", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/data/line?at=0,0,0,1,1,1,0,0,0", host), "HTTP/1.1 400");
    EXPECT_EQ(get("/../../../../etc/passwd", host), "HTTP/1.1 404");
    EXPECT_EQ(get("/%2e%2e/%2e%2e/etc/passwd", host), "HTTP/1.1 404");
    EXPECT_EQ(get("/data/scene", host + "Origin: http://example.org\r\n"), "HTTP/1.1 403");
    EXPECT_EQ(get("/data/scene", host + "Sec-Fetch-Site: cross-site\r\n"), "HTTP/1.1 403");
    EXPECT_EQ(get("/data/scene", "Host: example.org\r\nConnection: close\r\n"), "HTTP/1.1 403");
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
}

TEST(ProgramRender, TakesNumberedPicturesAlongAPath) {
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
