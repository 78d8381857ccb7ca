#include "exitance/cli/view/view_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <filesystem>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

std::string type_of(const fs::path& file) {
    const std::map<std::string, std::string> types{{".html", "text/html; charset=utf-8"},
                                                   {".js", "text/javascript; charset=utf-8"},
                                                   {".css", "text/css; charset=utf-8"},
                                                   {".svg", "image/svg+xml"}};
    const auto found = types.find(file.extension().string());
    return found == types.end() ? "application/octet-stream" : found->second;
}

/// Sends an answer without compression. A content provider is used because cpp-httplib compresses text with the slowest
/// setting of brotli: over a second for the page's script, for no gain on one machine.
void give(httplib::Response& response, ViewAnswer answer) {
    response.status = answer.status;
    if (answer.body.empty()) return;
    const auto body = std::make_shared<const std::string>(std::move(answer.body));
    response.set_content_provider(body->size(), answer.type.c_str(),
                                  [body](std::size_t from, std::size_t length, httplib::DataSink& sink) {
                                      return sink.write(body->data() + from, length);
                                  });
}

}  // namespace

struct ViewServer::Implementation {
    httplib::Server server;
    int port = 0;

    /// True if the request names this server as host and does not come from another site. Rejects other host names that
    /// resolve to 127.0.0.1 (DNS rebinding).
    bool is_own(const httplib::Request& request) const {
        const std::string host = request.get_header_value("Host"), origin = request.get_header_value("Origin");
        const std::string site = request.get_header_value("Sec-Fetch-Site");
        if (site == "cross-site" || site == "same-site") return false;
        for (const char* name : {"127.0.0.1", "localhost"}) {
            const std::string own = fmt::format("{}:{}", name, port);
            if (host == own && (origin.empty() || origin == "http://" + own)) return true;
        }
        return false;
    }
};

ViewServer::ViewServer() : implementation_(std::make_unique<Implementation>()) {
    httplib::Server& server = implementation_->server;
    server.set_payload_max_length(1 << 16);
    // Replaces the default of cpp-httplib (SO_REUSEPORT), with which two servers could share a port.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                {"Cache-Control", "no-store"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Content-Security-Policy",
                                 "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
                                 "frame-ancestors 'none'"}});
    server.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
        if (implementation_->is_own(request)) return httplib::Server::HandlerResponse::Unhandled;
        give(response, {403, "text/plain", "this server answers its own page only"});
        return httplib::Server::HandlerResponse::Handled;
    });
}

ViewServer::~ViewServer() = default;

Result<void> ViewServer::serve_page(const std::string& folder) {
    std::error_code failed;
    for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
        if (!at->is_regular_file()) continue;
        const Result<std::string> text = read_whole_file(at->path().string());
        if (!text) return text.error();
        const std::string name = fs::relative(at->path(), folder).generic_string();
        const auto answer = [content = ViewAnswer{200, type_of(at->path()), *text}](const Parameters&) {
            return content;
        };
        if (name == "index.html") get("/", answer);
        get("/" + name, answer);
    }
    return {};
}

void ViewServer::get(const std::string& path, Handler handler) {
    implementation_->server.Get(path, [handler](const httplib::Request& request, httplib::Response& response) {
        give(response, handler(request.params));
    });
}

void ViewServer::post(const std::string& path, Handler handler) {
    implementation_->server.Post(path, [handler](const httplib::Request& request, httplib::Response& response) {
        give(response, handler(request.params));
    });
}

void ViewServer::events(const std::string& path, EventSource source) {
    implementation_->server.Get(path, [source](const httplib::Request&, httplib::Response& response) {
        const auto provide = [source, next = std::size_t{0}](std::size_t, httplib::DataSink& sink) mutable {
            std::string text;
            const bool more = source(next, text);
            if (text.empty()) text = ": still here\n\n";
            if (!sink.write(text.data(), text.size())) return false;
            if (!more) sink.done();
            return true;
        };
        response.set_chunked_content_provider("text/event-stream", provide);
    });
}

Result<int> ViewServer::bind(int port) {
    httplib::Server& server = implementation_->server;
    const bool bound =
        port == 0 ? (port = server.bind_to_any_port("127.0.0.1")) > 0 : server.bind_to_port("127.0.0.1", port);
    if (!bound)
        return Error{ErrorCode::failure, fmt::format("port {} is in use", port), "--port",
                     "omit --port to get a free one"};
    return implementation_->port = port;
}

void ViewServer::listen() {
    implementation_->server.listen_after_bind();
}

Result<std::string> find_viewer_page() {
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed).parent_path();
    for (const char* folder : {"../viewer", "../share/exitance/viewer"}) {
        const fs::path page = (program / folder).lexically_normal();
        if (fs::exists(page / "index.html", failed)) return page.string();
    }
    return Error{ErrorCode::failure, "the viewer's page was not built", "",
                 "install nodejs (18 or later) and npm, then build exitance again"};
}

}  // namespace exitance
