-- Addresses that are told of events. Each has its place in the table of events: what has happened
-- after it is still to be told, so neither a crash nor a deaf receiver loses any.
CREATE TABLE webhook (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  created_at INTEGER NOT NULL,
  url TEXT NOT NULL,
  kinds TEXT NOT NULL,
  secret TEXT NOT NULL,
  former_secret TEXT,
  former_until INTEGER,
  state TEXT NOT NULL CHECK (state IN ('active', 'parked', 'disabled')),
  last_event INTEGER NOT NULL,
  failures INTEGER NOT NULL DEFAULT 0,
  next_at INTEGER NOT NULL,
  delivered INTEGER NOT NULL DEFAULT 0,
  failed INTEGER NOT NULL DEFAULT 0,
  account TEXT,
  CHECK ((former_secret IS NULL) = (former_until IS NULL))
) STRICT;

-- For /metrics.
CREATE INDEX event_of_drift ON event (id) WHERE kind = 'night.drift';
