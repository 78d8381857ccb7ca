#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// HTTP status, content type and body of an answer.
struct ViewAnswer {
    int status = 200;
    std::string type = "application/json", body;
};

/// Web server for the viewer's page, reachable only from this machine. It listens on 127.0.0.1. It rejects requests
/// with another host name or from another origin. It serves files from memory, so that no path can lead out of the
/// page's folder. Only this class uses cpp-httplib.
class ViewServer {
  public:
    using Parameters = std::multimap<std::string, std::string>;
    using Handler = std::function<ViewAnswer(const Parameters&)>;
    /// Sets `text` to the next server-sent events, or to an empty text after a wait without events. Returns false after
    /// the last event.
    using EventSource = std::function<bool(std::size_t& next, std::string& text)>;

    ViewServer();
    ~ViewServer();

    /// Reads every file of the page's folder into memory and serves it. Error: a file cannot be read.
    Result<void> serve_page(const std::string& folder);
    void get(const std::string& path, Handler handler);
    void post(const std::string& path, Handler handler);
    void events(const std::string& path, EventSource source);

    /// Binds a port (0: any free port) and returns it. Error (failure): the port is in use.
    Result<int> bind(int port);
    /// Answers requests on several threads. Returns only when the process ends.
    void listen();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Folder of the viewer's page, in the build folder or the installation of the running program. Error (failure): there
/// is none; the hint names the packages to install.
Result<std::string> find_viewer_page();

}  // namespace exitance
