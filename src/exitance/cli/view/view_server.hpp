#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

struct ViewAnswer {
    int status = 200;
    std::string type = "application/json", body;
};

/// A web server for the viewer's page on this machine alone: it listens on 127.0.0.1, answers only requests that name
/// it as their host and do not come from another origin, and knows the files of one folder by heart, so that no path
/// leads out of it. The one door to cpp-httplib.
class ViewServer {
  public:
    using Parameters = std::multimap<std::string, std::string>;
    using Handler = std::function<ViewAnswer(const Parameters&)>;
    /// The next server-sent events as text, waiting for some; an empty text while there are none, false at the end.
    using EventSource = std::function<bool(std::size_t& next, std::string& text)>;

    ViewServer();
    ~ViewServer();

    /// Reads every file of the page's folder.
    Result<void> serve_page(const std::string& folder);
    void get(const std::string& path, Handler handler);
    void post(const std::string& path, Handler handler);
    void events(const std::string& path, EventSource source);

    /// Takes a port, 0 for any that is free; returns it.
    Result<int> bind(int port);
    /// Answers requests, on threads of its own, until the process ends.
    void listen();

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Where the page is: beside the program as built, or as installed. An error says what to install.
Result<std::string> find_viewer_page();

}  // namespace exitance
