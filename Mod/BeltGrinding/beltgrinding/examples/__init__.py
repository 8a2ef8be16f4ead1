"""Complete models, offered in the menu and run as tests."""
