#include "workbench/options/experiment_options.h"

#include "workbench/options/shared_options.h"

namespace touchstone {

void defineExperiment(CLI::App& app, ExperimentOptions& options) {
    app.add_option("STUDY", options.study,
                   "A study, JSON; without it that of [004]: a polygon against a smooth cylinder")
        ->type_name("FILE");
    app.add_option("--out", options.out, "Folder of the sessions, the tables and plots/")->type_name("DIR");
    CLI::Option* print =
        app.add_flag("--print-study", options.printStudy, "Print the study, to begin one of your own from");
    CLI::Option* observer =
        app.add_flag("--observer", options.observer,
                     "Run it with simulated people, in seconds, and say how many people and trials it needs");
    CLI::Option* report =
        app.add_flag("--report", options.report, "Tables, analysis and plots of the sessions in --out");
    CLI::Option* person =
        app.add_option("--person", options.person,
                       "Lead a person through the session in a window, or go on with it; N counts from 1")
            ->type_name("N")
            ->check(CLI::Range(1, 100000));
    for (CLI::Option* option : {print, observer, report, person})
        for (CLI::Option* other : {print, observer, report, person})
            if (option != other)
                option->excludes(other);
    app.add_option("--seed", options.seed, "Of the order of the stimuli, and of the simulated people [1]")
        ->type_name("N");
    app.add_option("--people", options.people, "Simulated people [12]")
        ->type_name("N")
        ->check(CLI::Range(2, 1000))
        ->needs(observer);
    app.add_option("--attention", options.attention,
                   "Of the observer: everything, or tactile: where the location display moves, the direction "
                   "of the force is not used "
                   "[everything]")
        ->type_name("NAME")
        ->check(CLI::IsMember({"everything", "tactile"}))
        ->needs(observer);
    app.add_flag("--pilots", options.pilots, "The study's pilot conditions instead of the others")
        ->excludes(report);
    app.add_option("--device", options.device, "What the person holds: see touchstone devices [mouse]")
        ->type_name("NAME")
        ->needs(person);
    addRate(app, options.rateHz, "Rate of the haptic thread [1000]");
    app.add_flag("!--no-noise", options.noise, "No white noise while something is felt")->needs(person);
    addSize(app, "--size", options.size, "Size of the window [1280x800]");
    addGpu(app, options.gpu);
    app.add_option("--status-json", options.statusJson, "What the window shows, for scripts")
        ->type_name("FILE")
        ->needs(person);
    app.parse_complete_callback([&options] {
        const int modes = (options.printStudy ? 1 : 0) + (options.observer ? 1 : 0) +
                          (options.report ? 1 : 0) + (options.person > 0 ? 1 : 0);
        if (modes == 0)
            throw CLI::RequiredError("one of --person, --observer, --report and --print-study");
        if (!options.printStudy && options.out.empty())
            throw CLI::RequiredError("--out");
    });
}

} // namespace touchstone
