/* In the portable package in place of libcurl, by which Debian's HDF5 would read files from the
 * net, and which brings twelve megabytes of libraries. HDF5 finds that it cannot be used. */
int curl_global_init(long flags) {
    (void)flags;
    return 2; /* CURLE_FAILED_INIT */
}
void curl_global_cleanup(void) {}
void* curl_easy_init(void) {
    return 0;
}
int curl_easy_setopt(void* handle, int option, ...) {
    (void)handle, (void)option;
    return 2;
}
int curl_easy_perform(void* handle) {
    (void)handle;
    return 2;
}
void curl_easy_cleanup(void* handle) {
    (void)handle;
}
void* curl_slist_append(void* list, const char* text) {
    (void)list, (void)text;
    return 0;
}
void curl_slist_free_all(void* list) {
    (void)list;
}
