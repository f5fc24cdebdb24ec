"""All that mission control can do, a service a file; the API and the pages are its two faces."""
