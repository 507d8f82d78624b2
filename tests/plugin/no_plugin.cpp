/// A shared library like any other.
extern "C" int gridmerge_test_answer() { return 42; }
