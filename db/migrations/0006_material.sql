-- Grains that users describe themselves, beside the published ones.
CREATE TABLE material (
  name TEXT PRIMARY KEY,
  created_at INTEGER NOT NULL,
  document TEXT NOT NULL
) STRICT, WITHOUT ROWID;
