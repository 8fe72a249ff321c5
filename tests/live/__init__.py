"""A live film: its thread, its server, its page."""
