// Embree, OpenVDB and their TBB are not built with the thread sanitizer, so their own hand-overs are
// invisible to it and every block they free looks shared, as does what OpenVDB's tasks ask of ours (whether
// to stop). What we allocate beside their blocks (vertices, maps, records) is watched.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libembree3.so\n"
           "called_from_lib:libembree4.so\n"
           "called_from_lib:libtbb.so\n"
           "race:libembree3.so\n"
           "race:libembree4.so\n"
           "race:libopenvdb.so\n"
           "race:libtbb.so\n";
}
