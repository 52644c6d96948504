"""Commands on what runs leave behind: recordings, run directories, videos."""
