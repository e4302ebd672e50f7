"""`SqlCatalog`: the catalog on SQLite or PostgreSQL. Each method opens one transaction and leaves the rest to `sql`."""

from partwise.store.sql_catalog.base import SqlBase as SqlBase
from partwise.store.sql_catalog.base import utc_now as utc_now
from partwise.store.sql_catalog.collections import SqlCollectionCatalog
from partwise.store.sql_catalog.labels import SqlLabelCatalog
from partwise.store.sql_catalog.models import SqlModelCatalog
from partwise.store.sql_catalog.shapes import SqlShapeCatalog
from partwise.store.sql_catalog.stages import SqlStageCatalog


class SqlCatalog(SqlCollectionCatalog, SqlShapeCatalog, SqlStageCatalog, SqlLabelCatalog, SqlModelCatalog):
    """A catalog in a database of the known schema; get one from `partwise.store.open`. Safe to share between threads.

    Close it, or use it in a `with` block. See `Catalog` for what methods do.
    """
