// Only in builds with AddressSanitizer. The Vulkan loader unloads the driver at the end. What the driver
// keeps in its globals is then reachable from nowhere, and LeakSanitizer reports it, without a name that a
// suppression could match: 240 bytes in each process that draws. Where the driver stays loaded it reports
// none.

extern "C" int dlclose(void*) noexcept {
    return 0;
}
