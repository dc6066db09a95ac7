// OpenImageIO keeps the last error of each thread and image for ever.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenImageIO.so\n";
}
