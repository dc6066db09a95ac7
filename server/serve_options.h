#pragma once

#include <string>
#include <vector>

namespace touchstone::server {

/// What the command line says.
struct ServeOptions {
    int port = 0; ///< 0 with a socket: none
    std::string address = "127.0.0.1";
    std::vector<std::string> names;   ///< of this machine, beside the address
    std::vector<std::string> origins; ///< of other servers' pages that may connect
    std::string certificate, key;     ///< PEM files; empty: no TLS
    std::string socket;               ///< path of a Unix socket; empty: none
    std::string root = ".";           ///< scenes that clients name lie below it
    std::string scene;                ///< opened at first; empty: none
    std::string device = "stroke";
    bool allowWrite = false;
    double rate = 1000.0;
    double control = 0.0;   ///< Hz, of the control loop apart from contact; 0: none
    double goalPower = 0.0; ///< W that a client's contact may give
};

} // namespace touchstone::server
