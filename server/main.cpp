// touchstone serve: its options.

#include "server/network.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace {

/// CLI::Range lets NaN pass: it asks whether a value is below or above.
std::string isNumber(const std::string& text) {
    return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is no number" : std::string();
}

} // namespace

int main(int count, char** arguments) {
    using namespace touchstone::server;
    ServeOptions options;
    options.port = 8790;
    CLI::App app{"Touch for other programs: they load scenes, change settings and get states and ticks over "
                 "a WebSocket "
                 "(docs/server.md)."};
    app.name("touchstone serve");
    app.add_option("SCENE", options.scene, "Model to begin with")->type_name("");
    app.add_option("--root", options.root, "Clients may name scenes below this folder [.]")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory);
    app.add_option("--port", options.port, "With a token; 0: none [8790]")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    app.add_option("--socket", options.socket, "Also listen to this Unix socket, of mode 0600")
        ->type_name("PATH");
    app.add_option("--listen", options.address,
                   "IPv4 address of this machine; off loopback only with --certificate [127.0.0.1]")
        ->type_name("ADDRESS");
    app.add_option("--certificate", options.certificate, "TLS by this certificate (PEM), and its chain")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    app.add_option("--key", options.key, "Private key of the certificate (PEM)")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    app.add_option("--name", options.names,
                   "Name by which browsers call this server beside its address; may be repeated")
        ->type_name("HOST");
    app.add_option(
           "--origin", options.origins,
           "Pages of another server may connect, too, with the token: http://localhost:8000; may be repeated")
        ->type_name("ORIGIN");
    app.add_option(
           "--device", options.device,
           "What is held: stroke[:NAME] (a simulated hand), or a device as `run --device` takes (stroke in "
           "place of hand) [stroke]")
        ->type_name("DEVICE");
    app.add_option("--rate", options.rate, "Servo rate [1000]")
        ->type_name("HZ")
        ->check(CLI::Range(100.0, 4000.0))
        ->check(isNumber);
    app.add_option(
           "--control", options.control,
           "Control loop apart from contact, at HZ (docs/control.md): contact may be slower (--rate), or a "
           "client's [none]")
        ->type_name("HZ")
        ->check(CLI::Range(100.0, 4000.0))
        ->check(isNumber);
    app.add_option(
           "--goal-power", options.goalPower,
           "Power that a client's contact may give the hand; 0: late or wrong contact gives no energy [0]")
        ->type_name("W")
        ->check(CLI::Range(0.0, 10.0))
        ->check(isNumber);
    app.add_flag("--allow-write", options.allowWrite, "Clients may record into new files below the root");
    std::string web = TOUCHSTONE_WEB;
    try {
        app.parse(count, arguments);
    } catch (const CLI::Success& answered) { // --help
        return app.exit(answered);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "touchstone: %s\n  remedy: touchstone serve --help\n", error.what());
        return 2;
    }
    try {
        if (options.port == 0 && options.socket.empty())
            throw std::runtime_error("--port 0 needs --socket");
        struct sigaction action {};
        action.sa_handler = [](int) { stopServing(); };
        (void)sigaction(SIGINT, &action, nullptr);
        (void)sigaction(SIGTERM, &action, nullptr);
        (void)signal(SIGPIPE, SIG_IGN);
        const std::filesystem::path installed =
            std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../../share/touchstone/web";
        if (std::filesystem::exists(installed))
            web = installed.lexically_normal().string();
        serve(options, web);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "touchstone: %s\n", error.what());
        return 1;
    }
}
